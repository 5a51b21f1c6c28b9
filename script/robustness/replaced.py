"""Commands that are killed at random moments while they replace a finished result.

Afterwards each file is the old or the new one, each folder of a run is a whole run or is reported as unfinished, and the
same command succeeds and yields the new result."""

import json
import random
import shutil
import signal
import subprocess
import time

from robustness import fits
from robustness.inject import PATIENCE_S
from validation.runs import ROOT, Problem, table

UNFINISHED = ("the trace is unfinished", "no row")


class Fit:
    """A fit that is repeated with profiles, which changes its summary and its report."""
    name, out = "fit", "out"
    old = ("fit", "fit.yaml", "--threads", "1", "--quiet", "--out", "out")
    new = (*old, "--profile", "*")
    files, runs = fits.SAME_BYTES, fits.RUNS

    @staticmethod
    def prepare(folder):
        for name, text in fits.INPUTS.items():
            (folder / name).write_text(text)


class Shapes:
    """Modes and states of self-stress as runs, of a model whose parameter is changed."""
    name, out = "analyze --out", "shapes"
    old = ("analyze", ROOT / "share/models/prism3.yaml", "--modes", "3", "--out", "shapes")
    new = (*old, "--set", "height_m=0.25")
    files, runs = (), ("mode_1", "mode_2", "mode_3", "self_stress_1")

    @staticmethod
    def prepare(folder):
        pass


class Replacement:
    """A folder with the old result, and another one with the new result."""

    def __init__(self, program, command, folder):
        self.program, self.command, self.folder = program, command, folder
        self.before, self.right = folder / "before", folder / "right"
        self.before.mkdir(parents=True)
        command.prepare(self.before)
        self.plain(command.old, self.before)
        shutil.copytree(self.before, self.right)
        began_s = time.monotonic()
        self.plain(command.new, self.right)
        self.longest_s = time.monotonic() - began_s
        for run in command.runs:
            if not self.same(self.right, self.right, run) or self.same(self.before, self.right, run):
                if command is Shapes:
                    raise Problem(f"{command.name}: {run} does not differ between the old and the new result")

    def plain(self, words, folder):
        done = self.program.plain(words, folder)
        if done.returncode != 0:
            raise Problem(f"{self.command.name}: {done.stderr}")

    def compare(self, folder, reference, run):
        return self.program.plain(("compare", folder / self.command.out / run, reference / self.command.out / run, "--json",
                                   "--max_lag_s", "0"), folder)

    def same(self, folder, reference, run):
        """Returns whether the run is whole and has the rows of the reference."""
        done = self.compare(folder, reference, run)
        if done.returncode != 0:
            return False
        compared = json.loads(done.stdout)
        return compared["a"]["rows"] == compared["b"]["rows"] and all(
            channel["max_error"]["value"] == 0 for channel in compared["channels"])

    def killed(self, rng):
        """Kills the command in a copy of the old folder. Returns the copy, or None if the command had ended."""
        copy = self.folder / "killed"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.before, copy)
        process = subprocess.Popen([self.program.command, *map(str, self.command.new)], cwd=copy, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(self.longest_s * rng.random())
        lives = process.poll() is None
        process.send_signal(signal.SIGKILL)
        process.wait(PATIENCE_S)
        return copy if lives else None

    def look(self, copy):
        """Returns the states of the files and runs ("old", "new", "unfinished"), and an error or None."""
        states = []
        for name in self.command.files:
            path = copy / self.command.out / name
            content = path.read_bytes() if path.exists() else None
            whole = {state: (folder / self.command.out / name).read_bytes()
                     for state, folder in (("old", self.before), ("new", self.right))}
            state = next((state for state, wanted in whole.items() if content == wanted), None)
            if state is None:
                return states, f"{name} is neither the old nor the new file"
            if whole["old"] != whole["new"]:
                states.append(state)
        for run in self.command.runs:
            if self.same(copy, self.before, run):
                if not self.same(self.before, self.right, run):
                    states.append("old")
            elif self.same(copy, self.right, run):
                states.append("new")
            else:
                read = self.program.plain(("trace", "convert", copy / self.command.out / run, "--out", "unfinished.csv"), copy)
                if not any(word in read.stdout + read.stderr for word in UNFINISHED):
                    return states, f"{run} is no whole run: status {read.returncode}: {read.stdout}{read.stderr}"
                states.append("unfinished")
        again = self.program.plain(self.command.new, copy)
        if again.returncode != 0:
            return states, f"cannot go on: {again.stderr}"
        for name in self.command.files:
            if (copy / self.command.out / name).read_bytes() != (self.right / self.command.out / name).read_bytes():
                return states, f"gone on, {name} has other bytes"
        for run in self.command.runs:
            if not self.same(copy, self.right, run):
                return states, f"gone on, {run} differs"
        return states, None


def run(program, folder, count, seed, show):
    """Kills `count` processes of each command. Returns a list for the file of results."""
    items = []
    for command in (Fit, Shapes):
        rng = random.Random(f"{seed} {command.name}")
        item = {"command": command.name, "killed": 0, "old": 0, "new": 0, "mixed": 0, "unfinished": 0, "wrong": []}
        items.append(item)
        work = Replacement(program, command, folder / command.name.replace(" ", "_"))
        while item["killed"] < count:
            copy = work.killed(rng)
            if copy is None:
                continue
            item["killed"] += 1
            states, wrong = work.look(copy)
            item["unfinished" if "unfinished" in states else "old" if set(states) <= {"old"} else
                 "new" if set(states) == {"new"} else "mixed"] += 1
            if wrong:
                item["wrong"].append(wrong)
                show(f"\r\033[KWRONG  {command.name}: {wrong}\n")
            show(f"\r\033[K{command.name}: {item['killed']} of {count} killed")
        show("\r\033[K")
    return items


def summary(items):
    return table(["command", "kills", "all old", "all new", "some old, some new", "with a run reported as unfinished",
                  "wrong results"],
                 [[item["command"], *(str(item[key]) for key in ("killed", "old", "new", "mixed", "unfinished")),
                   str(len(item["wrong"]))] for item in items])
