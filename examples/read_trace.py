"""Oscillation period of a mass on a cable, read from an HDF5 trace: read_trace.py runs/hang/trace.h5"""

import sys

import h5py
import numpy as np

with h5py.File(sys.argv[1], "r") as trace:
    print("made by taut", trace.attrs["taut_version"].decode(), "from", trace.attrs["model"].decode())
    length = trace["cable/cable/length_m"]
    unit = length.attrs["unit"].decode()
    time_s, length_m = trace["time_s"][:], length[:]

above = length_m - length_m.mean()
rising = np.flatnonzero((above[:-1] < 0) & (above[1:] >= 0))
share = above[rising] / (above[rising] - above[rising + 1])
crossings_s = time_s[rising] + share * (time_s[rising + 1] - time_s[rising])
print(f"{len(time_s)} rows; between {length_m.min():.4f} and {length_m.max():.4f} {unit}")
print(f"period {np.diff(crossings_s).mean():.4f} s")
