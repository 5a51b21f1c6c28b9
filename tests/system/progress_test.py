"""Progress lines of searches have values with units, and the time left

Usage: progress_test.py TEST TAUT. TEST is the name of a function of this file.
"""

import os
import pathlib
import pty
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
FIT = """taut: 1
kind: fit
name: hang
experiments:
  - {{name: swing, experiment: {experiment}, data: data/trace.h5}}
estimate:
  - {{parameter: stiffness_n_per_m, low: 300, high: 500}}
residuals:
  - {{channel: cable/*/length_m, sd: 0.001, statistic: rows}}
search: {{step: 0.01}}
"""


def progress_of(taut, *words, cwd):
    """Runs a command with a terminal for standard error. Returns the text that the terminal got."""
    master, slave = pty.openpty()
    with subprocess.Popen([taut, *map(str, words)], cwd=cwd, stdout=subprocess.DEVNULL, stderr=slave) as done:
        os.close(slave)
        text = b""
        try:
            while more := os.read(master, 1 << 16):
                text += more
        except OSError:  # Linux: the other side is closed
            pass
        done.wait()
    os.close(master)
    return text.decode()


def ASearchShowsItsBestDistance(taut, folder):
    subprocess.run([taut, "new", "robot", "sam", "--like", "three_bar"], cwd=folder, check=True, capture_output=True)
    study = folder / "sam/learn.yaml"
    study.write_text(re.sub(r"evaluations: \d+", "evaluations: 16", study.read_text()))
    said = progress_of(taut, "learn", "sam", cwd=folder)
    assert re.search(r"\d+ of 16 evaluations  best: distance [\d.]+ m  0 failed  [\d.e+]+ simulated s/s  [\d:]+ left",
                     said), said


def AFitShowsItsValues(taut, folder):
    subprocess.run([taut, "run", "hang", "--set", "stiffness_n_per_m=410", "--out", "data"], cwd=folder, check=True,
                   capture_output=True)
    (folder / "fit.yaml").write_text(FIT.format(experiment=ROOT / "share/experiments/hang.yaml"))
    said = progress_of(taut, "fit", "fit.yaml", cwd=folder)
    assert re.search(r"searching: \d+ iterations  chi2 \S+  stiffness_n_per_m = [34]\S* N/m  \d+ experiments computed  "
                     r"at most \d+:\d\d left", said), said


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        globals()[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(work))
