"""What scripts/bench, bench-compare and bench-scaling share: builds, the benchmark programs of a build, their results."""

import json
import math
import os
import re
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def fail(message):
    sys.exit(f"{Path(sys.argv[0]).name}: {message}")


# ---- builds ---------------------------------------------------------------------------------------------------------

def build_here():
    """Builds the working tree; its folder of benchmark programs."""
    subprocess.run([ROOT / "scripts/build", "-DMOLTEN_BENCH=ON"], check=True, stdout=sys.stderr,
                   env=dict(os.environ, MOLTEN_TARGET="benchmarks"))
    return ROOT / "build/release/bench"


def programs_of(name):
    """The folder of benchmark programs that a person names: a build folder, a source folder with a build, or a git
    revision, which is built into build/compare/<commit> the first time."""
    for folder in (Path(name), Path(name) / "bench", Path(name) / "build/release/bench"):
        if os.access(folder / "step", os.X_OK) and (folder / "step").is_file():
            return folder.resolve()
    return build_revision(name)


def build_revision(revision):
    found = git("rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}", check=False)
    if not found:
        fail(f"{revision} is neither a folder with benchmark programs (bench/step) nor a git revision")
    source = ROOT / "build/compare" / found[:12]
    if not source.exists():
        git("worktree", "add", "--detach", "--quiet", str(source), found)
    models = source / "scenes/models"
    if not models.exists() and (ROOT / "scenes/models").exists():  # else its bunny is a ball
        models.symlink_to(ROOT / "scenes/models")
    print(f"building {revision} ({found[:12]}) in {source}", file=sys.stderr)
    subprocess.run([source / "scripts/build", "-DMOLTEN_BENCH=ON", "-DMOLTEN_TESTS=OFF"], check=True, stdout=sys.stderr)
    return source / "build/release/bench"


def git(*words, check=True):
    done = subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True)
    if check and done.returncode != 0:
        fail(f"git {words[0]}: {done.stderr.strip()}")
    return done.stdout.strip()


# ---- benchmarks -----------------------------------------------------------------------------------------------------

def plain(name):
    """A benchmark's own name, without how Google Benchmark times it."""
    return re.sub(r"/(iterations:\d+|repeats:\d+|min_time:[\d.]+|real_time|manual_time|process_time)", "", name)


def is_program(file):
    return file.is_file() and os.access(file, os.X_OK) and not file.suffix


def list_benchmarks(folder):
    """{name: program} of all programs of a build, in their order."""
    found = {}
    for program in sorted(f for f in folder.iterdir() if is_program(f)):
        done = subprocess.run([program, "--benchmark_list_tests"], capture_output=True, text=True)
        if done.returncode == 0:
            found.update((plain(line), program) for line in done.stdout.split())
    return found


def chosen(names, prefixes):
    """The names that a prefix matches; a prefix that is a whole name means that one alone."""
    hits = []
    for prefix in prefixes:
        matching = [prefix] if prefix in names else [n for n in names if n.startswith(prefix)]
        if not matching:
            fail(f"no benchmark's name begins with {prefix}")
        hits += [n for n in matching if n not in hits]
    return hits


def environment(threads, states):
    env = dict(os.environ, OMP_NUM_THREADS=str(threads))
    if states:
        env["MOLTEN_BENCH_STATES"] = str(states)
    return env


def run(program, words, threads, states=None):
    """The parsed JSON of one call."""
    done = subprocess.run([program, *words, "--benchmark_format=json"], stdout=subprocess.PIPE, text=True,
                          env=environment(threads, states))
    if done.returncode != 0 or not done.stdout:
        fail(f"{program} {' '.join(words)} ended with code {done.returncode}")
    result = json.loads(done.stdout)
    for line in result["benchmarks"]:
        if line.get("error_occurred"):
            fail(f"{line['name']}: {line['error_message']}")
    return result


def only(names):
    """Google Benchmark's filter for exactly these."""
    return f"--benchmark_filter=^({'|'.join(names)})(/iterations.*|/real_time|/manual_time)?$"


def run_one(program, name, threads, states, options):
    """One benchmark's line of the JSON."""
    lines = run(program, [only([name]), *options], threads, states)["benchmarks"]
    return next(line for line in lines if plain(line["name"]) == name)


def seconds(line):
    """Wall time of one iteration."""
    return line["real_time"] * {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}[line["time_unit"]]


# ---- statistics -----------------------------------------------------------------------------------------------------

def interval_of_median(values):
    """(low, high, coverage): the narrowest pair of order statistics that holds the median with 95 % confidence, or the
    extremes with less."""
    ordered, n = sorted(values), len(values)
    def coverage(k):  # of the k-th smallest to the k-th largest, k from 0
        return 1 - 2 * sum(math.comb(n, i) for i in range(k + 1)) / 2 ** n
    k = 0
    while k + 1 < n - 1 - (k + 1) and coverage(k + 1) >= 0.95:
        k += 1
    return ordered[k], ordered[n - 1 - k], coverage(k)


def ratio_line(name, ratios):
    low, high, coverage = interval_of_median(ratios)
    return f"{name:32} {statistics.median(ratios):8.4f}  [{low:.4f}, {high:.4f}] at {100 * coverage:.0f} %"


def figure(value):
    """Four digits and a metric prefix."""
    for factor, prefix in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if abs(value) >= factor:
            return f"{value / factor:.4g}{prefix}"
    return f"{value:.4g}"
