"""Prints the horizontal distance of the center of mass from start to end: moved.py RUN ..."""

import csv
import math
import sys

for run in sys.argv[1:]:
    with open(f"{run}/trace.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    start, end = ([float(row[f"system/com_{axis}_m"]) for axis in "xy"] for row in (rows[0], rows[-1]))
    print(f"{run}: {math.dist(start, end):.2f} m")
