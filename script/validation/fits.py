"""Fits of measured robots for pages: files of `kind: fit` as they are written, run and read back."""

import csv
import json
import math
import os
import pathlib
import subprocess

from validation.runs import ROOT, Problem

# Data that are not ours to pass on.
REFERENCE = pathlib.Path(os.environ.get("TAUT_REFERENCE", ROOT.parent / "shared" / "reference")) / "hardware"


def rows_of(path, header_lines):
    with open(path, newline="") as file:
        return [[float(x) for x in row] for row in list(csv.reader(file))[header_lines:]]


def write_rows(path, head, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([",".join(head), *(",".join(f"{x!r}" for x in row) for row in rows)]) + "\n")


class Fit:
    """What `taut fit` made of a file: its summary, by name."""

    def __init__(self, summary, status):
        self.summary, self.status = summary, status
        self.parameters = {p["name"]: p for p in summary["parameters"]}

    def points(self, which="test"):
        return self.summary["points"][which]

    def judgements(self):
        """All that hold, in words."""
        words = {"rejected": "rejected", "unidentifiable": "not identifiable",
                 "worse_on_hold_out": "worse than untuned on what was held out"}
        return [word for key, word in words.items() if self.summary[key]]


def run(taut, name, text, *flags):
    """Writes a fit into a folder within the page's and runs it there."""
    folder = taut.folder / name
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "fit.yaml"
    path.write_text(f"taut: 1\nkind: fit\nname: {folder.name}\n{text}")
    for old in folder.glob("fit.sqlite*"):
        old.unlink()
    done = subprocess.run([str(taut.command), "fit", str(path), "--out", str(folder), "--quiet", *flags],
                          capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise Problem(f"taut fit {path}\n{done.stdout}{done.stderr}".rstrip())
    return Fit(json.loads((folder / "summary.json").read_text()), done.returncode)


def beside(folder, path):
    """A file of the project as a fit in a folder names it."""
    return os.path.relpath(ROOT / path, folder)


def rms(points, channel, key="fitted", wanted=lambda p: True):
    """Root mean square of computed less measured."""
    errors = [p[key] - p["measured"] for p in points if p["channel"] == channel and wanted(p)]
    return math.sqrt(sum(e * e for e in errors) / len(errors))
