"""Blind fits: measurements with noise and a late clock from a randomly drawn truth, and errors of the estimates.

The inputs of a fit, its experiment and its data, never contain the truth, which is in a separate folder `truth`."""

import bisect
import csv
import math
import random


def drawn(key, spread):
    """Converts name: (nominal, sd) to name: a random number, reproducible from the text `key`."""
    chance = random.Random(key)
    return {name: nominal + sd * chance.uniform(-math.sqrt(3), math.sqrt(3)) for name, (nominal, sd) in spread.items()}


class Trace:
    """A CSV trace: columns by name."""

    def __init__(self, path):
        with open(path, newline="") as file:
            rows = list(csv.reader(file))
        self.of = {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}
        self.time_s = self.of["time_s"]

    def at(self, name, time_s):
        """Interpolates linearly between rows; constant before the first and after the last."""
        values, after = self.of[name], bisect.bisect_right(self.time_s, time_s)
        if after in (0, len(values)):
            return values[max(0, after - 1)]
        before_s, after_s = self.time_s[after - 1:after + 1]
        share = (time_s - before_s) / (after_s - before_s)
        return values[after - 1] + share * (values[after] - values[after - 1])

    def mean(self, name, from_s, to_s):
        """Returns the mean of the rows in a time span."""
        rows = [x for t, x in zip(self.time_s, self.of[name]) if from_s - 1e-9 <= t <= to_s + 1e-9]
        return sum(rows) / len(rows)


def measured(trace, sensors, key, rate_hz, until_s, late_s=0.0):
    """Returns rows of a logger with a late clock: time and one column per sensor. `sensors`: name -> (gain, offset, sd
    of the noise of a row, in the channel's unit)."""
    chance = random.Random(key)
    rows = []
    for i in range(int(round(until_s * rate_hz)) + 1):
        time_s = i / rate_hz
        if time_s < late_s:
            continue
        rows.append([time_s] + [gain * trace.at(name, time_s - late_s) + offset + chance.gauss(0, sd)
                                for name, (gain, offset, sd) in sensors.items()])
    return ["time_s", *sensors], rows


def error_of(parameter):
    """Returns the larger of the standard errors from J^T J and from omitted groups; infinite without one."""
    return max(parameter["se"], parameter["se_jackknife"] or 0) if parameter["se"] else math.inf


def off(parameter, truth):
    """Returns estimate - truth in standard errors; infinite for unbounded parameters, which never count as right."""
    error = error_of(parameter)
    return (parameter["value"] - truth) / error if math.isfinite(error) else math.inf


def digits(value, error):
    """Formats value and error with two digits of the error."""
    if not math.isfinite(error) or error <= 0:
        return f"{value:.4g}", "any"
    places = max(0, 1 - math.floor(math.log10(error)))
    return (f"{value:.{places}f}", f"{error:.{places}f}") if places < 7 else (f"{value:.4g}", f"{error:.2g}")
