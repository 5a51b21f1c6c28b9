"""Helpers of several tests of the Python module"""

import os
import pathlib
import signal
import sys
import threading
import unittest
import warnings

import taut

ROOT = pathlib.Path(__file__).resolve().parents[2]
PUSH = str(ROOT / "share/experiments" / "push_20n.yaml")
MASS = str(ROOT / "share/models" / "hanging_mass.yaml")
PRISM = str(ROOT / "share/models" / "prism3.yaml")
GAIT = str(ROOT / "share/experiments" / "sidewinder3_start.yaml")
FREQUENCY = "motion.sine.frequency_hz"
COMMAND = sys.argv[1]


def gait(seconds=0.3):
    experiment = taut.load(GAIT)
    experiment.duration_s = seconds
    return experiment


def interrupted(case, call):
    """Checks that `call` raises KeyboardInterrupt if Ctrl-C comes while it runs."""
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with case.assertRaises(KeyboardInterrupt):
        call()
    timer.join()


def main():
    """Runs the tests of the program; the first argument is the command's path."""
    del sys.argv[1]
    warnings.simplefilter("error")
    unittest.main()
