"""`taut fit` with failing calls: a new fit, and a fit that resumes after a kill."""

import contextlib
import json
import shutil
import sqlite3

from robustness.inject import Fault
from robustness.scenarios import Scenario, digest
from validation.runs import Problem

MODEL = """\
taut: 1
kind: model
name: hanging
parameters: {k_n_per_m: 100, mass_kg: 0.5}
nodes: {top: [0, 0, 1], ball: [0, 0, 0]}
pairs: [{name: c, nodes: [top, ball], tags: [cable]}]
builders:
  - {match: top, anchor: {}}
  - {match: ball, point_mass: {mass_kg: mass_kg, radius_m: 0.01}}
  - {match: cable, cable: {stiffness_n_per_m: k_n_per_m, damping_n_s_per_m: 8, rest_length_m: 0.9, actuator: {ideal: true}}}
"""
PULL = """\
taut: 1
kind: experiment
name: pull
model: model.yaml
gravity_m_per_s2: [0, 0, -10]
duration_s: 4
controllers:
  - {name: play, period_s: 0.01, position: {programs: [{cables: c, change_m: [[0, 0], [1, -0.01], [2, -0.02], [3, -0.03]]}]}}
"""
SWING = """\
taut: 1
kind: experiment
name: swing
model: model.yaml
gravity_m_per_s2: [0, 0, -10]
duration_s: 0.1
record: {rate_hz: 100}
"""
FIT = """\
taut: 1
kind: fit
name: spring
experiments:
  - {name: rest, experiment: pull.yaml, data: rest.csv, forward: static}
  - {name: swing, experiment: swing.yaml, data: swing.csv, use: test}
estimate:
  - {parameter: k_n_per_m, prior: {sd: 20}}
residuals:
  - {channel: node/ball/position_z_m, experiments: [rest], sd: 0.001, window: {after_setpoint_s: [-0.1, 0.1]}}
  - {channel: node/ball/position_z_m, experiments: [swing], sd: 0.001, statistic: rows}
groups: window
"""
INPUTS = {"model.yaml": MODEL, "pull.yaml": PULL, "swing.yaml": SWING, "fit.yaml": FIT,
          "rest.csv": "time_s,node/ball/position_z_m\n1,0.0654\n2,0.0746\n3,0.0856\n",
          "swing.csv": "time_s,node/ball/position_z_m\n0,0\n0.1,0.045\n"}
SAME_BYTES = ("summary.json", "report.html", "fitted_rest.yaml", "fitted_swing.yaml")
RUNS = ("untuned_rest", "fitted_rest", "untuned_swing", "fitted_swing")


class Fit(Scenario):
    """A fit in a new folder. After any fault, the same command must resume and yield the same bytes."""
    kills = True

    def __init__(self, program, folder):
        super().__init__(program, folder)
        for name, text in INPUTS.items():
            (self.before / name).write_text(text)
        self.right = folder / "right/out"
        shutil.copytree(self.before, folder / "right")
        self.made(*self.words(), folder=folder / "right")
        self.prepare()

    def prepare(self):
        pass

    def words(self):
        return ("fit", "fit.yaml", "--threads", "1", "--quiet", "--out", "out")

    def points(self, folder):
        """Returns the points in fit.sqlite; an empty dict if it or its table does not exist yet."""
        if not (folder / "fit.sqlite").exists():
            return {}
        with contextlib.closing(sqlite3.connect(folder / "fit.sqlite")) as db:
            try:
                return dict(db.execute("SELECT key, value FROM point").fetchall())
            except sqlite3.OperationalError:  # before its tables were created
                return {}

    def check(self, outcome, folder):
        inputs = {name: content for name, content in digest(folder).items() if not name.startswith("out/")}
        if inputs != {name: content for name, content in digest(self.before).items() if not name.startswith("out/")}:
            return "an input is not as it was"
        if outcome.status == 0 and (wrong := self.difference(folder / "out")):
            return f"status 0, and {wrong}"
        for name in SAME_BYTES:
            made = folder / "out" / name
            if made.exists() and made.read_bytes() != (self.right / name).read_bytes():
                return f"{name} has other bytes"
        right = self.points(self.right)
        if any(right.get(key) != value for key, value in self.points(folder / "out").items()):
            return "a point has other numbers"
        again = self.program.plain(self.words(), folder)
        if again.returncode != 0:
            return f"cannot go on: {again.stderr}"
        wrong = self.difference(folder / "out")
        return f"gone on, {wrong}" if wrong else None

    def difference(self, folder):
        """Describes the first difference from the correct folder; returns None if there is no difference."""
        for name in SAME_BYTES:
            if not (folder / name).exists() or (folder / name).read_bytes() != (self.right / name).read_bytes():
                return f"{name} is missing or has other bytes"
        for run in RUNS:
            if (wrong := self.difference_of_run(folder / run, self.right / run)):
                return f"{run} {wrong}"
        return None

    def difference_of_run(self, run, right):
        wanted = {name for name in digest(right) if name != ".lock"}
        if missing := wanted - set(digest(run)):
            return f"has no {', '.join(sorted(missing))}"
        end, right_end = (json.loads((folder / "summary.json").read_text()) for folder in (run, right))
        if end.get("state_hash") != right_end.get("state_hash"):
            return "ends in another state"
        read = self.program.plain(("compare", run / "trace.h5", right / "trace.h5", "--json", "--max_lag_s", "0"), run)
        if read.returncode != 0:
            return f"has an unreadable trace: {read.stderr}"
        compared = json.loads(read.stdout)
        same = compared["a"]["rows"] == compared["b"]["rows"] and all(
            channel["max_error"]["value"] == 0 for channel in compared["channels"])
        return None if same else "has another trace"


class FitResumed(Fit):
    """A fit that resumes in a folder in which it was killed after some of its points."""

    def prepare(self):
        calls = self.program.run(self.words(), shutil.copytree(self.before, self.before.parent / "counted")).calls
        for twentieths in range(1, 20):
            shutil.rmtree(self.before / "out", ignore_errors=True)
            self.program.run(self.words(), self.before, Fault("write", calls["write"] * twentieths // 20, "kill"))
            self.kept = len(self.points(shutil.copytree(self.before / "out", self.before.parent / f"half_{twentieths}")))
            if self.kept >= len(self.points(self.right)) // 2:
                break
        if not 0 < self.kept < len(self.points(self.right)):
            raise Problem(f"half a fit has {self.kept} of {len(self.points(self.right))} points")

    def check(self, outcome, folder):
        copy = shutil.copytree(folder / "out", folder.parent / f"kept_{folder.name}", dirs_exist_ok=True)
        kept = len(self.points(copy))
        shutil.rmtree(copy)
        if kept < self.kept:
            return f"{kept} of {self.kept} points are left"
        return super().check(outcome, folder)
