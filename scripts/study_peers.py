"""PySPH's own examples (Debian's python3-pysph), scored with the study's metrics: Taylor-Green vortices, the lid-driven
cavity and a dam break. Run times are those that PySPH reports for its solver: without set-up and compilation.
"""
import csv
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

SIZES = {"taylor-green": [25, 50, 100], "cavity": [25, 50], "koshizuka": [20, 33]}


def comment_free(file):
    with open(file, newline="") as f:
        return list(csv.DictReader(line for line in f if not line.startswith("#")))


def columns(file, *names):
    """Columns of a reference, or None with no folder."""
    folder = os.environ.get("MOLTEN_REFERENCE")
    path = Path(folder or "") / file
    if not folder or not path.exists():
        return None
    rows = comment_free(path)
    return [numpy.array([float(row[name]) for row in rows]) for name in names]


def solve(example, options, folder):
    """Seconds of the solver's loop, and the numbers of the example's own post-processing."""
    command = [sys.executable, "-m", f"pysph.examples.{example}", "--openmp", "-d", folder] + options
    done = subprocess.run(command, capture_output=True, text=True)
    took = re.search(r"Run took: ([0-9.]+)", done.stdout)
    result = Path(folder) / "results.npz"
    if done.returncode != 0 or not took or not result.exists():
        said = (done.stderr.strip() or done.stdout.strip() or "nothing").splitlines()[-1]
        raise RuntimeError(f"{example} ended with exit code {done.returncode}, saying: {said}")
    return float(took.group(1)), numpy.load(result)


def taylor_green(scheme, size, folder):
    options = ["--scheme", scheme, "--nx", str(size), "--perturb", "0.2", "--tf", "2"]
    seconds, r = solve("taylor_green", options, folder)
    return seconds, {"speed_l1": r["l1"][-1], "max_speed": r["linf"][-1], "pressure_l1": r["p_l1"][-1]}


def cavity(scheme, size, folder):
    seconds, r = solve("cavity", ["--scheme", scheme, "--nx", str(size), "--tf", "20"], folder)
    reference = columns("viscous/lid_cavity_Re100_computed_richardson.csv", "s", "u_at_x0.5", "v_at_y0.5")
    if reference is None:
        return seconds, {}
    s, u, v = reference

    def rms(line, exact):
        inside = (r["x"] >= 0) & (r["x"] <= 1)
        return float(numpy.sqrt(numpy.mean((line[inside] - numpy.interp(r["x"][inside], s, exact)) ** 2)))

    return seconds, {"u_rms": rms(r["u_c"], u), "v_rms": rms(r["v_c"], v)}


def front_of(x, spacing):
    """The fifth-farthest particle's far side, as here."""
    return float(numpy.sort(x)[-5] + spacing / 2)


def koshizuka(_, size, folder):
    """The example's column is 1 m wide, twice as high. (With 40 particles across PySPH 1.0b1 crashes.)"""
    from pysph.solver.utils import get_files, iter_output
    seconds, _ = solve("dam_break_2d", ["--dx", f"{1 / size:.6g}", "--tf", "0.75", "--pfreq", "25"], folder)
    reference = columns("dambreak/koshizuka_oka1996_exp_front_dualsphysics.csv", "t_s", "x_tip_m")
    if reference is None:
        return seconds, {}
    t, x = reference
    t, x = t[x < 3.9], x[x < 3.9]
    frames = iter_output(get_files(folder), "fluid")
    time, front = numpy.array([(frame["t"], front_of(fluid.x, 1 / size)) for frame, fluid in frames]).T

    def error(shift):
        return float(numpy.sqrt(numpy.mean((numpy.interp(t - shift, time, front) / x - 1) ** 2)))

    shifts = numpy.linspace(-0.3, 0.3, 2001) * t[-1]
    return seconds, {"front_raw": error(0), "front_shifted": min(error(shift) for shift in shifts)}


RUNS = {"taylor-green": (taylor_green, ["edac", "tvf"]), "cavity": (cavity, ["edac", "tvf"]),
        "koshizuka": (koshizuka, ["wcsph"])}


def run(file, say, read_rows, append_rows, cases, names):
    """Appends what `file` does not have yet."""
    done = {(row["case"], row["numerics"], row["size"]) for row in read_rows(file)}
    for case, (score, schemes) in RUNS.items():
        for scheme in schemes if case in cases else []:
            for size in SIZES[case]:
                name = f"PySPH {scheme}"
                if (case, name, str(size)) in done:
                    continue
                with tempfile.TemporaryDirectory() as folder:
                    try:
                        seconds, errors = score(scheme, size, folder)
                    except RuntimeError as error:
                        say(f"{case} {size} {name}: {error}")
                        continue
                append_rows(file, names, [{"case": case, "numerics": name, "dimensions": 2, "size": size,
                                           "wall_time_s": f"{seconds:.4g}", "quantity": quantity, "error": f"{e:.6g}"}
                                          for quantity, e in errors.items()])
                say(f"{case} {size} {name}: {seconds:.1f} s")
