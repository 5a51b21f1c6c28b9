"""Spectral lines and harmonics of a periodic signal, by Fourier sums over a window."""

import cmath
import math


def _project(values, row_s, frequency_hz, window):
    """Returns the complex amplitude c of c exp(2 pi i f t), with t from the middle of the window."""
    middle = (len(values) - 1) / 2
    total, weight = 0j, 0.0
    step = cmath.exp(-2j * math.pi * frequency_hz * row_s)
    turn = cmath.exp(2j * math.pi * frequency_hz * row_s * middle)
    for value, w in zip(values, window):
        total += w * value * turn
        weight += w
        turn *= step
    return 2 * total / weight


def _hann(count):
    return [0.5 - 0.5 * math.cos(2 * math.pi * (i + 0.5) / count) for i in range(count)]


def _centred(values):
    mean = sum(values) / len(values)
    return [value - mean for value in values]


def dominant(values, row_s, least_hz=0.2, most_hz=6.0):
    """Returns (frequency [Hz], amplitude) of the strongest line: searched on the frequency grid of the window,
    then between its neighbors to 0.1 mHz."""
    values, window = _centred(values), _hann(len(values))
    grid = 1 / (row_s * len(values))

    def size(frequency_hz):
        return abs(_project(values, row_s, frequency_hz, window))

    best = max((k * grid for k in range(math.ceil(least_hz / grid), int(most_hz / grid))), key=size)
    low, high = best - grid, best + grid
    while high - low > 1e-4:
        third = (high - low) / 3
        if size(low + third) < size(high - third):
            low += third
        else:
            high -= third
    frequency = (low + high) / 2
    return frequency, size(frequency)


def line_at(values, row_s, frequency_hz):
    """Returns (amplitude, phase [rad] of its cosine in the middle of the window) at a frequency."""
    c = _project(_centred(values), row_s, frequency_hz, _hann(len(values)))
    return abs(c), cmath.phase(c)


def harmonics(values, row_s, fundamental_hz, count):
    """Returns the complex amplitudes of the first `count` harmonics."""
    values, window = _centred(values), _hann(len(values))
    return [_project(values, row_s, n * fundamental_hz, window) for n in range(1, count + 1)]


def off_sine(spectrum):
    """Returns the remainder after subtraction of a sine with the signal's first harmonic, relative to the signal's
    rms."""
    return math.sqrt(sum(abs(c) ** 2 for c in spectrum[1:]) / sum(abs(c) ** 2 for c in spectrum))


def off_triangle(spectrum):
    """Same for a triangle wave with the signal's first harmonic: sum of cos(n x) / n^2, n odd."""
    first, left = spectrum[0], 0.0
    for n, c in enumerate(spectrum, start=1):
        triangle = abs(first) / n**2 * cmath.exp(1j * n * cmath.phase(first)) if n % 2 else 0
        left += abs(c - triangle) ** 2
    return math.sqrt(left / sum(abs(c) ** 2 for c in spectrum))
