"""Fits of measured robots for pages: files of `kind: fit`, written, run and read back."""

import csv
import json
import math
import os
import pathlib
import subprocess

from validation.runs import ROOT, Problem

# Data that we may not distribute.
REFERENCE = pathlib.Path(os.environ.get("TAUT_REFERENCE", ROOT.parent / "shared" / "reference")) / "hardware"


def rows_of(path, header_lines):
    with open(path, newline="") as file:
        return [[float(x) for x in row] for row in list(csv.reader(file))[header_lines:]]


def write_rows(path, head, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([",".join(head), *(",".join(f"{x!r}" for x in row) for row in rows)]) + "\n")


class Fit:
    """Summary of `taut fit` for a file, by name."""

    def __init__(self, summary, status):
        self.summary, self.status = summary, status
        self.parameters = {p["name"]: p for p in summary["parameters"]}

    def points(self, which="test"):
        return self.summary["points"][which]

    def judgements(self):
        """Returns all verdicts that apply, in words."""
        words = {"rejected": "rejected", "contradiction": "contradiction", "unidentifiable": "not identifiable",
                 "unreliable": "unreliable", "worse_on_hold_out": "worse than untuned on held-out data"}
        # All standard errors of a rejected fit are unreliable.
        return [word for key, word in words.items() if self.summary[key] and
                not (key == "unreliable" and self.summary["rejected"])]


def run(taut, name, text, *flags):
    """Writes a fit into a subfolder of the page's folder and runs it there."""
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
    """Returns the path of a project file relative to the folder of a fit."""
    return os.path.relpath(ROOT / path, folder)


def rms(points, channel, key="fitted", wanted=lambda p: True):
    """Returns the root mean square of computed minus measured values."""
    errors = [p[key] - p["measured"] for p in points if p["channel"] == channel and wanted(p)]
    return math.sqrt(sum(e * e for e in errors) / len(errors))
