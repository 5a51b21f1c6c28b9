"""Tensions of a Tetraspine3 run after its start, and differences between two runs: level, oscillation, time lag."""

import cmath
import csv
import gzip
import math

from validation.runs import Problem
from validation.waves import dominant, line_at

START_S = 5.0
CABLES = [f"{side}_{where}_{n}" for n in (1, 2) for side in ("outer", "inner") for where in ("right", "left", "top")]


def h5py():
    try:
        import h5py as module
    except ImportError:
        raise Problem("this page reads traces with h5py (Debian: python3-h5py)") from None
    return module


class Waves:
    """Tensions of the cables after the start [N], as arrays with constant row interval."""

    def __init__(self, time_s, tension_n_of, until_s=None, from_s=START_S):
        late = time_s >= from_s - 1e-9
        if until_s is not None:
            late &= time_s <= until_s + 1e-9
        self.time_s = time_s[late]
        self.row_s = float(self.time_s[1] - self.time_s[0])
        self.of = {cable: tension_n_of[cable][late] for cable in CABLES}

    def largest(self):
        return max(wave.max() for wave in self.of.values())

    def mean(self):
        return sum(wave.mean() for wave in self.of.values()) / len(self.of)

    def swing(self):
        """Returns the root mean square of the deviations from each cable's mean."""
        return (sum(wave.var() for wave in self.of.values()) / len(self.of)) ** 0.5

    def strongest(self):
        """Returns the dominant frequency [Hz] of the cable with the largest oscillation."""
        wave = max(self.of.values(), key=lambda wave: wave.var())
        return dominant(wave.tolist(), self.row_s)[0]

    def lines(self, frequency_hz):
        """Returns the complex amplitude of each cable at a frequency."""
        return {cable: cmath.rect(*line_at(wave.tolist(), self.row_s, frequency_hz)) for cable, wave in self.of.items()}


class Off:
    """Difference of a run from another one with the same rows; with `frequency_hz` also its time lag.

    `lag_s` is the common lag of all cables at this frequency; `aligned_n` is the rms difference that remains after
    removal of each cable's mean and of the lag."""

    def __init__(self, waves, reference, frequency_hz=None):
        pairs = [(waves.of[cable], reference.of[cable]) for cable in CABLES]
        self.rms_n = root([((a - b) ** 2).mean() for a, b in pairs])
        self.most_n = max(abs(a - b).max() for a, b in pairs)
        self.means_n = root([(a.mean() - b.mean()) ** 2 for a, b in pairs])
        self.swing = waves.swing() / reference.swing()
        self.lag_s = self.aligned_n = None
        if frequency_hz is not None:
            self._align(waves, reference, frequency_hz)

    def _align(self, waves, reference, frequency_hz):
        import numpy
        ours, theirs = waves.lines(frequency_hz), reference.lines(frequency_hz)
        turned = cmath.phase(sum(theirs[cable] * ours[cable].conjugate() for cable in CABLES))
        self.lag_s = turned / (2 * math.pi * frequency_hz)
        edge_s = 1 / frequency_hz  # shifted out of the window at either end
        time_s = reference.time_s
        inside = (time_s > time_s[0] + edge_s) & (time_s < time_s[-1] - edge_s)
        squares = []
        for cable in CABLES:
            moved = numpy.interp(time_s + self.lag_s, waves.time_s, waves.of[cable])[inside]
            still = reference.of[cable][inside]
            squares.append((((moved - moved.mean()) - (still - still.mean())) ** 2).mean())
        self.aligned_n = root(squares)


def root(squares):
    return float(sum(squares) / len(squares)) ** 0.5


def read_trace(path, until_s=None):
    with h5py().File(path, "r") as file:
        return Waves(file["time_s"][:], {cable: file[f"cable/{cable}/tension_n"][:] for cable in CABLES}, until_s)


def read_ntrt(path, from_s=START_S):
    """Reads NTRT's elastic tensions from a trace in tests/data/ntrt."""
    import numpy
    with gzip.open(path, "rt", newline="") as file:
        rows = list(csv.DictReader(file))
    column = {cable: numpy.array([float(row[f"{cable}_tension_N"]) for row in rows]) for cable in CABLES}
    return Waves(numpy.array([float(row["time_s"]) for row in rows]), column, None, from_s)
