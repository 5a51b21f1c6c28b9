"""Comparison of two versions of taut by instruction counts and alternating time measurements."""

import io
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import tarfile

from measuring.measure import command
from validation.runs import ROOT, Problem, table

LIMIT = 0.03  # a larger relative increase of the instructions is a regression
ROBOTS = ("tetraspine3", "tetraspine12", "six_strut")
LANES = (1, 4)  # valgrind does not support AVX-512
ROUNDS = 11
FOLDER = ROOT / "build/compare"


def program(version):
    """Builds step_counter against a commit, or against the working tree (None)."""
    if version is None:
        name, tree = "work", ROOT
    else:
        name = command("git", "rev-parse", "--verify", "--short=12", version + "^{commit}", cwd=ROOT).strip()
        tree = FOLDER / name / "tree"
        shutil.rmtree(tree, ignore_errors=True)
        archive = subprocess.run(["git", "archive", name], cwd=ROOT, capture_output=True, check=True).stdout
        tarfile.open(fileobj=io.BytesIO(archive)).extractall(tree)
    build = FOLDER / name / "build"
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    command("cmake", "-S", ROOT / "benchmarks/compare", "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
            f"-DTAUT_TREE={tree}", *launcher)
    command("cmake", "--build", build, "--target", "step_counter")
    return build / "step_counter"


def by_valgrind(words, *options, absent=None):
    """Returns the instructions of a command; None if its exit status is `absent`."""
    run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *options, *map(str, words)],
                         capture_output=True, text=True)
    if absent is not None and run.returncode == absent:
        return None
    match = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or not match:
        raise Problem(run.stderr.rstrip())
    return int(match[1])


def counter():
    """Returns a function that counts the instructions of a command."""
    def perf(words):
        run = subprocess.run(["perf", "stat", "-x,", "-e", "instructions:u", *map(str, words)],
                             capture_output=True, text=True)
        match = re.search(r"^(\d+),[^,]*,instructions", run.stderr, re.MULTILINE)
        return int(match[1]) if match else None

    if shutil.which("perf") and perf(["true"]) is not None:
        return "perf", perf
    if shutil.which("valgrind"):
        return "valgrind", by_valgrind
    raise Problem("counting instructions needs perf or valgrind (script/setup)")


def instructions(count, path, robot, lanes, steps=200):
    """Returns the instructions of one step: the additional cost of `steps` steps, so that start and end cancel."""
    few, many = (count([path, robot, lanes, n]) for n in (steps, 2 * steps))
    return (many - few) / steps


def times(paths, robot, lanes, steps):
    """Returns the median duration of a step of each program [s], measured alternately."""
    found = [[] for _ in paths]
    for _ in range(ROUNDS):
        for path, taken in zip(paths, found):
            taken.append(float(command(path, robot, lanes, steps)) / steps)
    return [statistics.median(taken) for taken in found]


def verdict(rows):
    """Returns status and text for rows of (case, instructions before, after)."""
    worse = [case for case, before, after in rows if after > (1 + LIMIT) * before]
    if worse:
        return 1, f"more than {100 * LIMIT:g} % more instructions: {', '.join(worse)}"
    return 0, f"no case takes more than {100 * LIMIT:g} % more instructions"


def main(base, new=None):
    os.makedirs(FOLDER, exist_ok=True)
    paths = [program(base), program(new)]
    tool, count = counter()
    rows, cells = [], []
    for robot in ROBOTS:
        for lanes in LANES:
            case = f"{robot}, {lanes} lane{'s' * (lanes > 1)}"
            before, after = (instructions(count, path, robot, lanes) for path in paths)
            took = times(paths, robot, lanes, 5000)
            rows.append((case, before, after))
            cells.append([case, f"{before:.0f}", f"{after:.0f}", f"{100 * (after / before - 1):+.2f} %",
                          f"{1e9 * took[0]:.0f}", f"{1e9 * took[1]:.0f}", f"{100 * (took[1] / took[0] - 1):+.1f} %"])
    print(table(["case", f"instructions a step in {base}", f"in {new or 'the working tree'}", "change",
                 "ns a step", "now", "change"], cells))
    print(f"\nInstructions by {tool}; times are medians of {ROUNDS} runs in turns and do not decide.")
    status, words = verdict(rows)
    print(words)
    return status
