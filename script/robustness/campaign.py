"""Fault injection campaign: all faults of a scenario, several in parallel, and a table of the outcomes."""

import collections
import concurrent.futures
import dataclasses
import random
import shutil
import threading
import time

from robustness.commands import ALL
from robustness.inject import KILL_KINDS, Fault
from robustness.scenarios import View, said
from validation.runs import Problem, table

MOST_POINTS = 2000   # default limit per kind and mode for memory faults
MORE_CALLS = 1.1     # factor for calls beyond the counted ones: timing may cause more


@dataclasses.dataclass
class Tally:
    """Outcomes of the faults of one scenario, kind and mode. `points` of the `calls` were made to fail."""
    calls: int = 0
    points: int = 0
    right: int = 0    # the result was correct all the same
    said: int = 0     # the command reported the failure, and complete files stayed complete
    killed: int = 0   # the process was killed there, and complete files stayed complete
    in_hdf5: int = 0  # same as `said`, but HDF5 itself crashed for lack of memory
    wrong: list = dataclasses.field(default_factory=list)


def faults_of(scenario, calls, kinds, every, most=None):
    """Returns every call of each kind; of memory allocations every n-th. `most`: limit for each kind and mode."""
    for kind in scenario.kinds:
        if kind not in kinds or not calls[kind]:
            continue
        count = calls[kind]
        if isinstance(scenario, View):
            count = int(MORE_CALLS * count)
        step = (every or max(1, count // MOST_POINTS)) if kind in ("memory", "hdf5") else 1
        if most:
            step = max(step, -(-count // most))
        modes = ["once", "sticky"] + (["kill"] if scenario.kills and kind in KILL_KINDS else [])
        for mode in modes:
            for at in range(1, count + 1, step):
                yield Fault(kind, at, mode)


class Campaign:
    """Runs the faults. `show(text)` receives the progress. `jobs`: number of parallel runs. The tallies are valid at
    any moment, also after an interrupt."""

    def __init__(self, program, folder, show=lambda text: None, jobs=1):
        self.program, self.folder, self.show, self.jobs = program, folder, show, jobs
        self.tallies = collections.defaultdict(Tally)  # by (scenario, kind, mode)

    def prepare(self, name):
        """Returns the scenario, and the number of its calls of each kind."""
        scenario = ALL[name](self.program, self.folder / name)
        outcome, _, wrong = self.point(scenario, None)
        if wrong or outcome.status != 0:
            raise Problem(f"{name} without faults: {wrong or outcome.errors}")
        return scenario, outcome.calls

    def point(self, scenario, fault):
        """Returns the command's outcome, its category, and an error, if any."""
        work = self.folder / f"work_{threading.get_native_id()}"
        shutil.rmtree(work, ignore_errors=True)
        shutil.copytree(scenario.before, work)
        outcome = scenario.run(work, fault)
        bad_end, how = said(outcome), "right" if outcome.status == 0 else "said"
        if fault and fault.mode == "kill" and outcome.failed:
            bad_end, how = None, "killed"
        elif bad_end and fault and fault.kind == "hdf5" and outcome.status is not None:
            bad_end, how = None, "in_hdf5"
        return outcome, how, bad_end or scenario.check(outcome, work)

    def points(self, scenario, faults):
        """Runs all faults in order."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            try:
                yield from zip(faults, pool.map(lambda fault: self.point(scenario, fault), faults))
            finally:
                pool.shutdown(cancel_futures=True)

    def run(self, names, kinds, every=None, sample=None, seed=1, most=None):
        """Runs all faults, or `sample` of them per scenario, with the same probability for kinds with many and with
        few calls."""
        for name in names:
            scenario, calls = self.prepare(name)
            faults = list(faults_of(scenario, calls, kinds, every, most))
            if sample is not None:
                faults = drawn(faults, sample, random.Random(f"{seed} {name}"))
            self.run_faults(name, scenario, calls, faults)

    def run_faults(self, name, scenario, calls, faults):
        began_s = time.monotonic()
        for done, (fault, (outcome, how, wrong)) in enumerate(self.points(scenario, faults)):
            tally = self.tallies[name, fault.kind, fault.mode]
            tally.calls = calls[fault.kind]
            if wrong:
                tally.wrong.append({"at": fault.at, "first": outcome.first, "what": wrong})
                self.show(f"\r\033[KWRONG  {name}, {fault} ({outcome.first}): {wrong}\n")
            if not wrong and not outcome.failed:
                continue  # this time there were fewer calls
            tally.points += 1
            if not wrong:
                setattr(tally, how, getattr(tally, how) + 1)
            left_s = (time.monotonic() - began_s) / (done + 1) * (len(faults) - done - 1)
            self.show(f"\r\033[K{name}: {done + 1} of {len(faults)}, {fault.kind} {fault.mode}, {left_s:.0f} s left")
        self.show("\r\033[K")


def drawn(faults, count, rng):
    groups = collections.defaultdict(list)
    for fault in faults:
        groups[fault.kind, fault.mode].append(fault)
    return [rng.choice(groups[group]) for group in rng.choices(sorted(groups), k=count)]


def results(tallies):
    """Returns the tallies for a file."""
    return [{"scenario": name, "kind": kind, "mode": mode, **dataclasses.asdict(tally)}
            for (name, kind, mode), tally in tallies.items()]


def summary(items):
    """Formats a table: one line per scenario and kind, all modes together."""
    rows = collections.defaultdict(lambda: [0, 0, 0, 0, 0, 0, 0])
    for item in items:
        row = rows[item["scenario"], item["kind"]]
        row[0] = max(row[0], item["calls"])
        for i, key in enumerate(("points", "right", "said", "killed", "in_hdf5"), 1):
            row[i] += item[key]
        row[6] += len(item["wrong"])
    return table(["command", "kind of call", "calls", "faults", "correct result", "error reported", "killed", "HDF5 crashed", "wrong result"],
                 [[name, kind, *map(str, row)] for (name, kind), row in rows.items()])
