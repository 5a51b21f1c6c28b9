"""Commands that run while calls fail, and the conditions that must hold afterwards.

A scenario has a folder with an initial state, created once: with a finished run, or half a study. Each fault
gets a copy of it. `check` describes errors of the command's end and of the files that it left. There is no error
if the result is correct, or if the command reported the failure and complete files stayed complete."""

import contextlib
import hashlib
import json
import re
import shutil
import signal
import sqlite3
import time

from robustness.inject import Fault
from validation.runs import ROOT, Problem

EXPERIMENT = """\
taut: 1
kind: experiment
base: {root}/share/experiments/{base}.yaml
name: {name}
duration_s: {duration_s}
"""
SWING = EXPERIMENT.format(root=ROOT, base="hang", name="swing", duration_s=0.1) + """\
timeline: {phases: {all: [0, 0.05]}}
record: {rate_hz: 200, channels: ["cable/*", "body/*", "system/*"]}
"""
CRAWL = EXPERIMENT.format(root=ROOT, base="sidewinder3_start", name="crawl", duration_s=0.02)
STUDY = """\
taut: 1
kind: study
name: crawl
experiment: crawl.yaml
vary:
  - {name: frequency, each: motion.sine.frequency_hz, low: 0.2, high: 2, scale: log}
objective: {measure: distance}
worlds: {count: 2, friction: 0.2}
search:
  - {method: monte_carlo, evaluations: 6, batch: 2}
"""


def digest(folder, without=()):
    """Returns the files in a folder and hashes of their content."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file() and path.name not in without}


def said(outcome):
    """Describes an error in how the command ended; returns None for a correct end."""
    if outcome.status is None:
        return "hangs"
    if outcome.status < 0:
        return f"ended by {signal.Signals(-outcome.status).name}"
    if outcome.status != 0 and not re.search(r"error: |cannot (be|write)\b", outcome.errors):
        return f"status {outcome.status} and no error: {outcome.errors!r}"
    return None


class Scenario:
    """Base of all scenarios. `kinds`: calls that may fail here; for `kill`, calls at which the process may be
    killed."""
    kinds = ("memory", "hdf5", "write", "sync", "name", "open", "truncate", "close", "read")
    kills = False

    def __init__(self, program, folder):
        self.program, self.before = program, folder / "before"
        shutil.rmtree(folder, ignore_errors=True)
        self.before.mkdir(parents=True)

    def made(self, *words, folder=None):
        """Runs a command that must succeed."""
        run = self.program.plain(words, folder or self.before)
        if run.returncode != 0:
            raise Problem(f"taut {' '.join(map(str, words))}\n{run.stdout}{run.stderr}")
        return run.stdout

    def words(self):
        raise NotImplementedError

    def run(self, folder, fault=None):
        return self.program.run(self.words(), folder, fault)

    def check(self, outcome, folder):
        """Describes an error of the files after a good end; returns None if there is no error."""
        raise NotImplementedError


class Run(Scenario):
    """A run into the folder of another, finished run."""
    kills = True

    def __init__(self, program, folder):
        super().__init__(program, folder)
        (self.before / "swing.yaml").write_text(SWING)
        self.made("run", "swing.yaml", "--duration_s", "0.05", "--csv", "--quiet", "--out", "run")
        self.made(*self.words()[:-1], folder / "right")
        self.old, self.right = self.before / "run", folder / "right"

    def words(self):
        return ("run", "swing.yaml", "--csv", "--quiet", "--out", "run")

    @staticmethod
    def end(folder):
        summary = json.loads((folder / "summary.json").read_text())
        return summary["state_hash"], summary["simulated_s"]

    def same_trace(self, name, folder, reference):
        return self.same_rows(folder / "run" / name, reference / "trace.csv")

    def same_rows(self, trace, reference):
        run = self.program.plain(("compare", trace, reference, "--json", "--max_lag_s", "0"), trace.parent)
        if run.returncode != 0:
            return False
        compared = json.loads(run.stdout)
        rows = len(reference.read_text().splitlines()) - 1
        return rows == compared["a"]["rows"] == compared["b"]["rows"] and all(
            channel["rows"] == rows and channel["max_error"]["value"] == 0 for channel in compared["channels"])

    def check(self, outcome, folder):
        """Checks that summary and traces belong to the same run."""
        good = outcome.status == 0
        read = self.program.plain(("report", "run/trace.h5"), folder)  # this command may complete the replacement
        if read.returncode != 0:
            return f"neither the old run nor the new one is left: {read.stderr}"
        if not (folder / "run/summary.json").exists():
            return "no summary, status 0" if good else None  # marked as unfinished
        try:
            end = self.end(folder / "run")
        except (ValueError, KeyError) as error:
            return f"summary.json is cut off: {error}"
        if good and end != self.end(self.right):
            return "status 0, and the summary is of another run"
        for reference in (self.old, self.right):
            if end != self.end(reference):
                continue
            if not self.same_trace("trace.h5", folder, reference):
                return f"trace.h5 is not that of the summary ({reference.name})"
            if good and not self.same_trace("trace.csv", folder, reference):
                return f"trace.csv is not that of the summary ({reference.name})"
            return None
        return f"summary of no run that there was: {end}"


class Learn(Scenario):
    """A study that resumes after an interruption."""
    kills = True

    def __init__(self, program, folder):
        super().__init__(program, folder)
        (self.before / "crawl.yaml").write_text(CRAWL)
        (self.before / "study.yaml").write_text(STUDY)
        whole = program.run(("learn", "study.yaml", "--quiet", "--threads", "1", "--out", folder / "right"),
                            self.before)
        if whole.status != 0:
            raise Problem(f"taut learn\n{whole.errors}")
        self.right = self.rows(folder / "right")
        half = Fault("write", whole.calls["write"] * 2 // 3, "kill")
        program.run(self.words(), self.before, half)
        self.kept = len(self.resumed(folder / "half", shutil.copytree(self.before, folder / "half"))[0])
        if not 0 < self.kept < len(self.right):
            raise Problem(f"half a study has {self.kept} of {len(self.right)} evaluations")

    def words(self):
        return ("learn", "study.yaml", "--threads", "1", "--quiet", "--out", "study")

    @staticmethod
    def rows(folder):
        """Returns all evaluations with their numbers."""
        log = folder / "study.sqlite"
        with contextlib.closing(sqlite3.connect(log)) as db:
            evaluations = db.execute("SELECT id, search, score, failed, parameter_values FROM evaluation").fetchall()
            worlds = db.execute("SELECT evaluation, world, seed, score, state_hash FROM world").fetchall()
        return {row[0]: (row, sorted(world for world in worlds if world[0] == row[0])) for row in evaluations}

    def resumed(self, _, folder):
        """Returns the rows in a copy of the folder, and the rows after resuming the study there."""
        try:
            rows = self.rows(folder / "study")
        except sqlite3.DatabaseError:
            rows = {}
        run = self.program.plain(self.words(), folder)
        return rows, run

    def check(self, outcome, folder):
        rows, again = self.resumed(None, folder)
        if len(rows) < self.kept:
            return f"{len(rows)} of {self.kept} evaluations are left"
        if outcome.status == 0 and rows != self.right:
            return "status 0, and not all evaluations are there"
        if any(self.right[number] != row for number, row in rows.items()):
            return "an evaluation has other numbers"
        if again.returncode != 0:
            return f"cannot go on: {again.stderr}"
        if self.rows(folder / "study") != self.right:
            return "gone on, it has other evaluations"
        return None


class Reader(Scenario):
    """A command that reads complete files, and prints or writes one file."""
    kinds = ("memory", "hdf5", "write", "open", "close", "read")
    command, makes = (), ()
    prints = True  # prints the result, not only its path
    beside = ("experiment.yaml", "study.sqlite-shm", "study.sqlite-wal")  # files created for reading a study

    def __init__(self, program, folder):
        super().__init__(program, folder)
        self.prepare()
        self.whole = digest(self.before, self.makes + self.beside)
        copy = shutil.copytree(self.before, folder / "right")
        self.right = self.run(copy)
        if said(self.right) or self.right.status != 0:
            raise Problem(f"taut {' '.join(map(str, self.words()))}: {self.right.errors}")
        self.made_right = {name: (copy / name).read_bytes() for name in self.makes}

    def prepare(self):
        (self.before / "swing.yaml").write_text(SWING)
        self.made("run", "swing.yaml", "--csv", "--quiet", "--out", "run")

    def words(self):
        return self.command

    def check(self, outcome, folder):
        if digest(folder, self.makes + self.beside) != self.whole:
            return "what it reads is not as it was"
        if outcome.status != 0 or "warning: " in outcome.errors:
            return None
        if self.prints and outcome.output != self.right.output:
            return "status 0, and it printed something else"
        for name, right in self.made_right.items():
            if (folder / name).read_bytes() != right:
                return f"status 0, and {name} is something else"
        return None


class Check(Reader):
    command = ("check", "swing.yaml")


class Compare(Reader):
    command = ("compare", "run/trace.h5", "run/trace.csv", "--json")


class Report(Reader):
    command, makes, prints = ("report", "run/trace.h5", "--out", "report.html"), ("report.html",), False


class Top(Reader):
    command = ("learn", "--top", "5", "--json", "study")

    def prepare(self):
        (self.before / "crawl.yaml").write_text(CRAWL)
        (self.before / "study.yaml").write_text(STUDY)
        self.made("learn", "study.yaml", "--quiet", "--threads", "1", "--out", "study")


class View(Scenario):
    """A live run that is recorded until SIGTERM. The number of calls depends on the time of the signal."""

    RECORDS_S = 0.7   # longer than rows are buffered
    BEGINS_S = 30

    def __init__(self, program, folder):
        super().__init__(program, folder)
        (self.before / "swing.yaml").write_text(SWING)

    def words(self):
        return ("view", "swing.yaml", "--out", "live", "--port", "0", "--speed", "1")

    def run(self, folder, fault=None):
        return self.program.run(self.words(), folder, fault, during=self.end)

    def end(self, process, shared, output):
        """Lets the session record for a while after the server starts, or until the fault; then sends SIGTERM."""
        limit = time.monotonic() + self.BEGINS_S
        serves = None
        while process.poll() is None and time.monotonic() < limit and not shared.failed:
            if serves is None and "http://" in output():
                serves = time.monotonic()
                limit = serves + self.RECORDS_S
            time.sleep(0.02)
        # A command that fails before it serves ends without a signal.
        while process.poll() is None and "http://" not in output() and time.monotonic() < limit:
            time.sleep(0.02)
        time.sleep(0.1)
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)

    def check(self, outcome, folder):
        if outcome.status != 0:
            return None
        if outcome.failed and "error: " in outcome.errors:
            return None
        trace = folder / "live/trace.h5"
        if not trace.exists():
            return "status 0, no error, and no recording"
        read = self.program.plain(("compare", trace, trace), folder)
        return None if read.returncode == 0 else f"status 0, and the recording cannot be read: {read.stderr}"
