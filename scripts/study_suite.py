#!/usr/bin/env python3
"""Runs many cases of the study, keeps their results, and reports run time against error.

Called by scripts/study; the program that it runs is build/release/bench/study. Results are kept in FOLDER/results.csv,
a line as soon as a run ends, so that a study that was stopped goes on where it stopped. FOLDER/report.md has the tables,
FOLDER/*.png the pictures (log error over log run time; python3-matplotlib, if it is there).
"""
import argparse
import csv
import math
import os
import statistics
import subprocess
import sys
import time
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/release/bench/study"
COLUMNS = ["case", "numerics", "dimensions", "particles", "size", "steps", "wall_time_s", "quantity", "error", "reach"]
KEPT = ["commit", "preset", "settings", "threads", "status"] + COLUMNS

# Presets, and changes to "molten": what the study compares. What this version of the program does not have is refused
# by it, which takes no time and is tried again when the study goes on.
PRESETS = ["molten", "basic", "internal", "dias", "paiva", "queiroz"]
CHANGES = [["numerics." + key for key in keys.split()] for keys in [
    "kernel=cubic_spline", "kernel=gaussian", "smoothing_ratio=1.3", "smoothing_ratio=1.5", "smoothing_ratio=1.6",
    "smoothing_ratio=1.7", "smoothing_ratio=2", "precision=double",
    "integrator=symplectic_euler", "integrator=predictor_corrector", "integrator=runge_kutta_4",
    "artificial_viscosity=0", "artificial_viscosity=0.02", "gradient_correction=true", "gradient_correction=false",
    "gradient_correction=true laplacian=consistent",
    "density_diffusion=0.1", "density_diffusion=0.1 wall_support=true", "density_diffusion=0.2 wall_support=true",
    'density_filter={kind="shepard"}', 'density_filter={kind="mls"}', "tensile_correction=true"]]
COMMIT = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty"], capture_output=True,
                        text=True).stdout.strip() or "unknown"
DEFAULT_SIZES = ([16, 32], 16)
MARGINS = [2, 4, 8]  # times the time step

# Sizes of the full study, and the one of the quick study (at most 50 particles a side, 20 s a case).
SIZES = {
    "taylor-green": ([25, 50, 100, 200], 50), "cavity": ([25, 50, 100], 40), "couette": ([10, 20, 40], 20),
    "poiseuille": ([10, 20, 40], 20), "smd-channel": ([8, 16, 32], 8), "bingham-channel": ([8, 16, 32], 8),
    "hot-spot": ([25, 50, 100, 200], 50), "two-slabs": ([25, 50, 100, 200], 50),
    "standing-wave": ([16, 32, 64], 24), "hydrostatic-box": ([16, 32, 64], 32), "hydrostatic-bowl": ([16, 32], 8),
    "slope-yield": ([8, 16, 32], 8), "floating-box": ([20, 40], 20), "vent-flux": ([10, 20, 40], 20),
    "elliptic-drop": ([20, 40, 80, 160], 40), "rotating-patch": ([25, 50, 100], 50),
    "cruchaga-a": ([18, 36, 72], 36), "cruchaga-b": ([18, 36, 72], 36), "lobovsky-front": ([30, 60, 120], 40),
    "lobovsky-pressure": ([30, 60, 120], 40), "martin-moyce": ([15, 30, 60], 30), "koshizuka": ([20, 40, 80], 40),
    "kleefsman": ([12000, 100000, 400000], 12000),
    "dias-a": ([18, 36, 72], 18), "dias-b": ([18, 36, 72], 18), "dias-lobovsky": ([47, 94, 187], 24),
    "dias-tank": ([17, 33], 17),
}
FULL_SETTINGS = {"kleefsman": ["end_time=6"]}  # quick: 2 s, the default
QUICK_SETTINGS = {"hydrostatic-bowl": ["end_time=1.2"]}  # 20 000 triangles of wall
MARGIN_CASES = ["taylor-green", "koshizuka", "hot-spot", "standing-wave"]


def say(line):
    print(f"study: {line}", file=sys.stderr, flush=True)


def known_cases():
    page = subprocess.run([PROGRAM, "--list"], check=True, capture_output=True, text=True).stdout
    return [line.split("|")[1].strip() for line in page.splitlines()[2:] if line.startswith("|")]


def sizes_of(case):
    return SIZES.get(case, DEFAULT_SIZES)[0]


def plan(quick, cases):
    """(case, size, preset, settings): the smallest size of every case first; a study that is stopped has seen them all."""
    if quick:
        return [(case, SIZES.get(case, DEFAULT_SIZES)[1], "dias" if case.startswith("dias-") else "molten",
                 QUICK_SETTINGS.get(case, [])) for case in cases]
    levels = max(len(sizes_of(case)) for case in cases)
    return [run for level in range(levels) for case in cases for run in full_runs(case, level)]


def full_runs(case, level):
    """The runs of a case at its size number `level`; changes to "molten" at its two smallest."""
    sizes, more = sizes_of(case), FULL_SETTINGS.get(case, [])
    if level >= len(sizes):
        return []
    runs = [(preset, more) for preset in PRESETS]
    if level < (1 if case == "kleefsman" else 2):
        runs += [("molten", more + change) for change in CHANGES]
    if level == 1 and case in MARGIN_CASES:
        runs += [(preset, more + [f"step_factor={k}"]) for preset in PRESETS for k in MARGINS]
    return [(case, sizes[level], preset, settings) for preset, settings in runs]


def key_of(row):
    return row["case"], int(row["size"]), row["preset"], row["settings"]


def read_rows(file, columns=None):
    if not file.exists():
        return []
    with open(file, newline="") as f:
        rows = list(csv.DictReader(f))
    if rows and columns and list(rows[0]) != columns:
        sys.exit(f"study: {file}: its columns are of another version; move it away or choose another folder with -o")
    return rows


def append_rows(file, columns, rows):
    new = not file.exists()
    with open(file, "a", newline="") as f:
        writer = csv.DictWriter(f, columns, lineterminator="\n")
        if new:
            writer.writeheader()
        writer.writerows(rows)
        f.flush()
        os.fsync(f.fileno())


def run_one(case, size, preset, settings, limit):
    """Rows of one run; one row with the status alone when it gave none."""
    command = [PROGRAM, "--case", case, "--size", str(size), "--numerics", preset]
    for setting in settings:
        command += ["--set", setting]
    head = {"commit": COMMIT, "preset": preset, "settings": " ".join(settings),
            "threads": os.environ.get("OMP_NUM_THREADS", "all")}
    nothing = dict.fromkeys(COLUMNS, "") | {"case": case, "size": size} | head
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return [nothing | {"status": "too long"}]
    if done.returncode not in (0, 4):
        say(done.stderr.strip().splitlines()[-1] if done.stderr else f"exit code {done.returncode}")
        return [nothing | {"status": f"refused ({done.returncode})"}]
    status = "diverged" if done.returncode == 4 else "done"
    rows = [head | {"status": status} | row for row in csv.DictReader(done.stdout.splitlines())]
    return rows or [nothing | {"status": "no references"}]


def run_all(runs, file, limit):
    rows = read_rows(file, KEPT)
    others = {row["commit"] for row in rows} - {COMMIT}
    if others:
        say(f"{file} has results of commit {', '.join(sorted(others))}, which stay; -o names a folder for new ones")
    done = {key_of(row) for row in rows if not row["status"].startswith("refused")}
    too_long = {}  # case, preset and settings: the smallest size that took too long

    def note(row):
        if row["status"] == "too long":
            of = row["case"], row["preset"], row["settings"]
            too_long[of] = min(int(row["size"]), too_long.get(of, math.inf))

    for row in rows:
        note(row)
    left = [r for r in runs if (r[0], r[1], r[2], " ".join(r[3])) not in done]
    if len(left) < len(runs):
        say(f"{len(runs) - len(left)} of {len(runs)} runs are there already, in {file}")
    for k, (case, size, preset, settings) in enumerate(left):
        name = " ".join([case, str(size), preset] + settings)
        if size > too_long.get((case, preset, " ".join(settings)), math.inf):
            say(f"[{k + 1}/{len(left)}] {name}: left out, a smaller one took too long")
            continue
        began = time.monotonic()
        rows = run_one(case, size, preset, settings, limit)
        note(rows[0])
        append_rows(file, KEPT, rows)
        say(f"[{k + 1}/{len(left)}] {name}: {rows[0]['status']}, {time.monotonic() - began:.1f} s")


# ---- the report ---------------------------------------------------------------------------------------------------


def number(text):
    try:
        return float(text)
    except ValueError:
        return math.nan


def judged(rows):
    """Per case and quantity with a reach: rows with numbers, quickest first."""
    groups = defaultdict(list)
    for row in rows:
        point = dict(row, time=number(row["wall_time_s"]), err=number(row["error"]), goal=number(row["reach"]))
        if row["quantity"] and math.isfinite(point["goal"]):
            point["counted"] = max(point["err"], point["goal"] / 10)  # less is chance: errors pass through zero
            groups[row["case"], row["quantity"]].append(point)
    return {name: sorted(points, key=lambda p: p["time"]) for name, points in groups.items()}


def changes(p):
    """What a run changes in its preset; its other settings belong to the case."""
    return " ".join(s for s in p["settings"].split() if s.startswith(("numerics.", "step_factor=")))


def front(points):
    """The points that no quicker one beats."""
    best, kept = math.inf, []
    for p in sorted(points, key=lambda p: p["time"]):
        if p["err"] < best and "step_factor" not in p["settings"]:
            best = p["err"]
            kept.append(p)
    return kept


def label(p):
    return p["numerics"] or p["preset"]


def percent(x):
    return f"{100 * x:.3g} %" if math.isfinite(x) else "–"


def smallest_table(groups):
    lines = ["| case | quantity | reach | best | with | size | run time |", "|---|---|---|---|---|---|---|"]
    for (case, quantity), points in groups.items():
        sound = [p for p in points if math.isfinite(p["err"])]
        if not sound:
            lines.append(f"| {case} | {quantity} | {percent(points[0]['goal'])} | – | no run gave a number | | |")
            continue
        p = min(sound, key=lambda p: p["err"])
        met = "**" if p["err"] <= p["goal"] else ""
        lines.append(f"| {case} | {quantity} | {percent(p['goal'])} | {met}{percent(p['err'])}{met} | {label(p)} | "
                     f"{p['size']} | {p['time']:.3g} s |")
    return lines


def cheapest_table(groups):
    goals = [0.01, 0.005, 0.001]
    lines = ["| case | quantity | " + " | ".join(f"{percent(g)} for" for g in goals) + " |", "|---|---|---|---|---|"]
    for (case, quantity), points in groups.items():
        cells = []
        for goal in goals:
            enough = [p for p in front(points) if p["err"] <= goal]
            cells.append(f"{enough[0]['time']:.3g} s: {label(enough[0])}, {enough[0]['size']}" if enough else "–")
        lines.append(f"| {case} | {quantity} | " + " | ".join(cells) + " |")
    return lines


def mean_ratio(pairs, key):
    return statistics.geometric_mean([p[key] / own[key] for p, own in pairs]) if pairs else math.nan


def change_table(groups):
    """What a change to "molten" does to error and run time of the runs of the same size, over all that is judged."""
    pairs = defaultdict(list)
    for points in groups.values():
        own = {p["size"]: p for p in points if p["preset"] == "molten" and not changes(p)}
        for p in points:
            if p["preset"] == "molten" and "numerics." in changes(p) and p["size"] in own:
                pairs[changes(p)].append((p, own[p["size"]]))
    lines = ["| change | judged | error less by 10 % | more by 10 % | of them failed | error, times | run time, times |",
             "|---|---|---|---|---|---|---|"]
    for change, both in pairs.items():
        sound = [(p, own) for p, own in both if math.isfinite(p["err"]) and min(p["time"], own["time"]) > 0]
        error = mean_ratio(sound, "counted")
        seconds = mean_ratio(sound, "time")
        failed = sum(not math.isfinite(p["err"]) for p, _ in both)
        better = sum(p["counted"] < 0.9 * own["counted"] for p, own in both)
        worse = failed + sum(p["counted"] > 1.1 * own["counted"] for p, own in both if math.isfinite(p["err"]))
        lines.append(f"| {change.replace('numerics.', '')} | {len(both)} | {better} | {worse} | {failed} | {error:.2f} | "
                     f"{seconds:.2f} |")
    return lines if len(lines) > 2 else []


def margin_table(groups):
    """Error over time step for each preset, against its own step."""
    lines = ["| case | quantity | preset | " + " | ".join(f"step × {k}" for k in [1] + MARGINS) + " |",
             "|---|---|---|" + "---|" * (1 + len(MARGINS))]
    for (case, quantity), points in groups.items():
        for preset in PRESETS:
            of_preset = [p for p in points if p["preset"] == preset]
            pushed = {p["settings"].split("step_factor=")[1]: p for p in of_preset if "step_factor=" in p["settings"]}
            if not pushed:
                continue
            size = next(iter(pushed.values()))["size"]
            own = [p for p in of_preset if p["size"] == size and not changes(p)]
            cells = [percent(own[0]["err"]) if own else "–"]
            for k in MARGINS:
                p = pushed.get(str(k))
                cells.append("" if not p else "diverged" if p["status"] == "diverged" else percent(p["err"]))
            lines.append(f"| {case} | {quantity} | {preset} | " + " | ".join(cells) + " |")
    return lines if len(lines) > 2 else []


def peer_lines(groups, peers):
    """At a peer's best error how much less run time, at its run time how much less error."""
    lines = ["| case | quantity | peer | its best error | run time there / here | error there / here in its time |",
             "|---|---|---|---|---|---|"]
    for (case, quantity), points in groups.items():
        best = {}
        for p in peers.get((case, quantity), []):
            if math.isfinite(p["err"]) and p["err"] < best.get(p["numerics"], p)["err"] or p["numerics"] not in best:
                best[p["numerics"]] = p
        for name, p in best.items():
            ours = front(points)
            as_good = [o for o in ours if o["err"] <= p["err"]]
            as_quick = [o for o in ours if o["time"] <= p["time"]]
            time_ratio = f"{p['time'] / as_good[0]['time']:.3g}" if as_good and math.isfinite(p["time"]) else "–"
            error_ratio = f"{p['err'] / as_quick[-1]['err']:.3g}" if as_quick else "–"
            lines.append(f"| {case} | {quantity} | {name} | {percent(p['err'])} | {time_ratio} | {error_ratio} |")
    return lines if len(lines) > 2 else []


def published_peers():
    """Errors that others published; without run times."""
    found = defaultdict(list)
    folder = os.environ.get("MOLTEN_REFERENCE")
    if not folder:
        return found
    for row in read_comment_csv(Path(folder) / "viscous/peer_pysph_taylor_green_Re100.csv"):
        if row["scheme"] in ("edac", "tvf"):
            found["taylor-green", "speed_l1"].append({"numerics": f"PySPH {row['scheme']}, published", "size": row["nx"],
                                                      "time": math.nan, "err": number(row["l1_t2"])})
    for row in read_comment_csv(Path(folder) / "viscous/peer_pysph_cavity_Re100.csv"):
        for axis in "uv":
            found["cavity", f"{axis}_rms"].append({"numerics": f"PySPH {row['scheme']}, published", "size": row["nx"],
                                                   "time": math.nan, "err": number(row[f"{axis}_rms"])})
    return found


def read_comment_csv(file):
    if not file.exists():
        return []
    with open(file, newline="") as f:
        return list(csv.DictReader(line for line in f if not line.startswith("#")))


def measured_peers(file):
    found = defaultdict(list)
    for row in read_rows(file):
        found[row["case"], row["quantity"]].append(
            dict(row, time=number(row["wall_time_s"]), err=number(row["error"])))
    return found


def draw_series(axes, points):
    """Presets in colours; changes to the default and longer time steps in grey, which the tables name."""
    series = defaultdict(list)
    for p in points:
        series[p["preset"], changes(p)].append(p)
    for (preset, change), of_one in series.items():
        style = {"color": "0.75", "lw": 0.5, "ms": 3, "zorder": 1}
        if not change:
            style = {"color": f"C{PRESETS.index(preset)}", "lw": 1.2, "ms": 6, "label": preset}
        axes.plot([p["time"] for p in of_one], [p["err"] for p in of_one], ".-", **style)
    axes.plot([], [], ".-", color="0.75", lw=0.5, label="changes to these")


def draw_front(axes, best):
    axes.plot([p["time"] for p in best], [p["err"] for p in best], "k-", lw=2.5, alpha=0.35, label="front")
    for p in best:
        axes.annotate(f"{label(p)}, {p['size']}", (p["time"], p["err"]), fontsize=5, xytext=(2, -6),
                      textcoords="offset points")


def draw_peers(axes, peers):
    for p in peers:
        name = f"{p['numerics']} {p['size']}"
        if math.isfinite(p["time"]):
            axes.plot(p["time"], p["err"], "r*", ms=9)
            axes.annotate(name, (p["time"], p["err"]), fontsize=6)
        else:
            axes.axhline(p["err"], color="r", lw=0.5, ls=":")
            axes.annotate(name, (0.99, p["err"]), xycoords=("axes fraction", "data"), ha="right", fontsize=6, color="r")


def draw(groups, peers, folder):
    """One picture a quantity. Returns their names; none without matplotlib."""
    try:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
    except ImportError:
        say("no pictures: python3-matplotlib is not there")
        return []
    names = []
    for (case, quantity), points in groups.items():
        shown = [p for p in points if p["err"] > 0 and math.isfinite(p["err"]) and p["time"] > 0]
        if not shown:
            continue
        figure, axes = pyplot.subplots(figsize=(7, 5))
        draw_series(axes, shown)
        draw_front(axes, front(shown))
        draw_peers(axes, peers.get((case, quantity), []))
        axes.axhline(shown[0]["goal"], color="g", lw=1, ls="--", label="reach")
        axes.set(xscale="log", yscale="log", xlabel="run time, s", ylabel="error", title=f"{case}: {quantity}")
        axes.set_ylim(top=min(axes.get_ylim()[1], 3))  # what blew up is in the tables
        axes.grid(True, which="both", lw=0.2)
        axes.legend(fontsize=6)
        name = f"study-{case}-{quantity}.png"
        figure.tight_layout()
        figure.savefig(folder / name, dpi=110)
        pyplot.close(figure)
        names.append(name)
    return names


def report(folder):
    rows = read_rows(folder / "results.csv", KEPT)
    groups = judged(rows)
    peers = published_peers()
    for name, points in measured_peers(folder / "peers.csv").items():
        peers[name] += points
    pictures = draw(groups, peers, folder)
    sections = [("Least errors", smallest_table(groups), "Bold: within reach."),
                ("Cheapest settings for an error", cheapest_table(groups), ""),
                ("Peers", peer_lines(groups, peers), "Run times of peers are measured beside ours, where given."),
                ("Changes to the default", change_table(groups),
                 "Means are geometric, over what did not fail; errors below a tenth of the reach count as a tenth."),
                ("How far the time step can be pushed", margin_table(groups), "")]
    text = "# Results of the study\n\nWritten by `scripts/study`.\n"
    for title, lines, note in sections:
        if lines:
            text += f"\n## {title}\n\n" + (note + "\n\n" if note else "") + "\n".join(lines) + "\n"
    if pictures:
        text += "\n## Pictures\n\n" + "\n".join(f"![{name}]({name})" for name in pictures) + "\n"
    (folder / "report.md").write_text(text)
    say(f"{folder / 'report.md'} and {len(pictures)} pictures")


def main():
    parser = argparse.ArgumentParser(prog="scripts/study", description=__doc__.splitlines()[0])
    parser.add_argument("--full", action="store_true", help="every case, resolution and numerics; may take hours")
    parser.add_argument("--quick", action="store_true", help="every case once, small")
    parser.add_argument("--peers", action="store_true", help="PySPH's examples, scored with the same metrics")
    parser.add_argument("--report", action="store_true", help="only the report, of the results that are there")
    parser.add_argument("--cases", help="only these, with commas in between")
    parser.add_argument("-o", "--output", type=Path, help="folder (default: runs/study, runs/study-quick)")
    parser.add_argument("--limit", type=float, help="s; a run that takes longer is given up")
    options = parser.parse_args()
    folder = options.output or ROOT / ("runs/study-quick" if options.quick else "runs/study")
    folder.mkdir(parents=True, exist_ok=True)
    cases = known_cases()
    if options.cases:
        asked = options.cases.split(",")
        unknown = [c for c in asked if c not in cases]
        if unknown:
            sys.exit(f"study: --cases: no case {unknown[0]}; there are {', '.join(cases)}")
        cases = asked
    if options.peers:
        import study_peers
        study_peers.run(folder / "peers.csv", say, read_rows, append_rows, cases, COLUMNS)
    elif not options.report:
        run_all(plan(options.quick, cases), folder / "results.csv", options.limit or (150 if options.quick else None))
    report(folder)


if __name__ == "__main__":
    main()
