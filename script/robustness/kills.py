"""`taut run` and `taut learn`, killed at random moments, and the work lost by that.

Both print their progress on a terminal about five times per second. The progress lines and their times are compared
with the data on disk: the loss is the time from the moment at which the stored progress was reached to the kill."""

import json
import os
import pty
import random
import re
import select
import shutil
import signal
import subprocess
import time

from robustness.inject import PATIENCE_S
from robustness.scenarios import CRAWL, STUDY, Learn
from validation.runs import ROOT, Problem, table

STEP_S, ROW_S, SIMULATED_S = "1e-5", 0.005, 12
EVALUATIONS = 3000


class OnTerminal:
    """A command whose progress is read from a terminal."""

    def __init__(self, command, words, folder, number):
        self.number, self.shown, self.text = re.compile(number), [], ""  # shown: (seconds, progress)
        self.terminal, theirs = pty.openpty()
        self.began_s = time.monotonic()
        self.process = subprocess.Popen([command, *map(str, words)], cwd=folder, stdin=subprocess.DEVNULL,
                                        stdout=theirs, stderr=theirs)
        os.close(theirs)

    def read_until(self, end_s):
        """Reads until `end_s` seconds after the start. Returns whether the command still runs."""
        while (left_s := self.began_s + end_s - time.monotonic()) > 0:
            if not select.select([self.terminal], [], [], left_s)[0]:
                break
            if not self.read():
                return False
        return self.process.poll() is None

    def read(self):
        try:
            text = os.read(self.terminal, 65536).decode(errors="replace")
        except OSError:  # the other end is closed
            return False
        self.text += text
        found = self.number.findall(self.text)
        if found:
            self.shown.append((time.monotonic() - self.began_s, float(found[-1])))
            self.text = self.text[self.text.rfind(found[-1]):]
        return bool(text)

    def kill(self):
        """Kills the command; returns the time since its start [s]."""
        killed_s = time.monotonic() - self.began_s
        self.process.send_signal(signal.SIGKILL)
        self.process.wait(PATIENCE_S)
        while select.select([self.terminal], [], [], 0)[0] and self.read():
            pass
        os.close(self.terminal)
        return killed_s

    def loss_s(self, kept, killed_s):
        """Returns the time between reaching the stored progress and the kill [s], by interpolation between progress
        lines."""
        reached = [(0.0, 0.0), *self.shown]
        for (from_s, low), (to_s, high) in zip(reached, reached[1:]):
            if low <= kept < high:
                return killed_s - (from_s + (to_s - from_s) * (kept - low) / (high - low))
        return killed_s - reached[-1][0] if kept <= reached[-1][1] else 0.0


def killed_runs(program, folder, count, rng, show):
    words = ("run", ROOT / "share/experiments/hang.yaml", "--step_s", STEP_S, "--duration_s", SIMULATED_S)
    began_s = time.monotonic()
    right = program.plain((*words, "--quiet", "--csv", "--out", "right"), folder)
    longest_s = time.monotonic() - began_s
    if right.returncode != 0:
        raise Problem(right.stderr)
    killed = 0
    while killed < count:
        run = OnTerminal(program.command, (*words, "--out", "killed"), folder, r"t = ([\d.]+) of")
        lives = run.read_until(0.9 * longest_s * rng.random() ** 2)  # favors early moments
        killed_s = run.kill()
        killed += lives
        show(f"\r\033[Krun: {killed} of {count} killed")
        if lives:
            yield (killed_s, *look_at_run(program, folder, run, killed_s))
        shutil.rmtree(folder / "killed", ignore_errors=True)


def look_at_run(program, folder, run, killed_s):
    """Returns rows, lost seconds, and an error or None."""
    if not (folder / "killed/trace.h5").exists():
        return 0, run.loss_s(0, killed_s), None
    read = program.plain(("compare", "killed/trace.h5", "right/trace.csv", "--json", "--max_lag_s", "0"), folder)
    if read.returncode != 0:
        if "no row" in read.stderr or "no time in common" in read.stderr:
            return 0, run.loss_s(0, killed_s), None
        return 0, killed_s, f"the trace cannot be read: {read.stderr}"
    compared = json.loads(read.stdout)
    rows = compared["a"]["rows"]
    wrong = None
    if any(channel["max_error"]["value"] != 0 for channel in compared["channels"]):
        wrong = "rows are others than those of the whole run"
    if (folder / "killed/summary.json").exists():
        wrong = "there is a summary"
    return rows, run.loss_s(rows * ROW_S, killed_s), wrong


def killed_searches(program, folder, count, rng, show):
    (folder / "crawl.yaml").write_text(CRAWL)
    (folder / "study.yaml").write_text(STUDY.replace("evaluations: 6", f"evaluations: {EVALUATIONS}"))
    words = ("learn", "study.yaml", "--threads", "1")
    began_s = time.monotonic()
    right = program.plain((*words, "--quiet", "--out", "right"), folder)
    longest_s = time.monotonic() - began_s
    if right.returncode != 0:
        raise Problem(right.stderr)
    wanted = Learn.rows(folder / "right")
    killed = 0
    while killed < count:
        search = OnTerminal(program.command, (*words, "--out", "killed"), folder, rf"(\d+) of {EVALUATIONS}")
        lives = search.read_until(0.9 * longest_s * rng.random() ** 2)
        killed_s = search.kill()
        killed += lives
        show(f"\r\033[Klearn: {killed} of {count} killed")
        if lives:
            yield (killed_s, *look_at_search(program, folder, (*words, "--quiet", "--out", "killed"), search,
                                             killed_s, wanted))
        shutil.rmtree(folder / "killed", ignore_errors=True)


def look_at_search(program, folder, words, search, killed_s, wanted):
    """Returns evaluations, lost seconds, and an error or None."""
    rows = {}
    if (folder / "killed/study.sqlite").exists():
        copy = shutil.copytree(folder / "killed", folder / "looked_at")  # reading recovers a log
        try:
            rows = Learn.rows(copy)
        except Exception as error:  # no table yet
            if "no such table" not in str(error):
                return 0, killed_s, f"the log cannot be read: {error}"
        finally:
            shutil.rmtree(copy)
    loss_s = search.loss_s(len(rows), killed_s)
    if any(wanted[number] != row for number, row in rows.items()):
        return len(rows), loss_s, "an evaluation has other numbers"
    again = program.plain(words, folder)
    if again.returncode != 0:
        return len(rows), loss_s, f"cannot go on: {again.stderr}"
    return len(rows), loss_s, None if Learn.rows(folder / "killed") == wanted else "gone on, it differs"


def run(program, folder, count, seed, show):
    """Kills `count` processes of each command. Returns a list for the file of results."""
    items = []
    for name, killed in {"run": killed_runs, "learn": killed_searches}.items():
        work = folder / f"kills_{name}"
        work.mkdir()
        item = {"command": name, "killed": 0, "early": 0, "without_rows": 0, "rows": 0, "largest_loss_s": 0.0,
                "largest_early_loss_s": 0.0, "wrong": []}
        items.append(item)
        for killed_s, rows, loss_s, wrong in killed(program, work, count, random.Random(f"{seed} {name}"), show):
            item["killed"] += 1
            item["early"] += killed_s < 1
            item["without_rows"] += rows == 0
            item["rows"] += rows
            item["largest_loss_s"] = max(item["largest_loss_s"], loss_s)
            if killed_s < 1:
                item["largest_early_loss_s"] = max(item["largest_early_loss_s"], loss_s)
            wrong = wrong or (f"{loss_s:.2f} s are lost" if loss_s >= 1 else None)
            if wrong:
                item["wrong"].append({"killed_s": killed_s, "what": wrong})
                show(f"\r\033[KWRONG  {name}, killed after {killed_s:.2f} s: {wrong}\n")
        show("\r\033[K")
    return items


def summary(items):
    return table(["command", "kills", "kills in the first second", "kills before the first row", "largest loss [s]",
                  "largest loss in the first second [s]", "wrong results"],
                 [[item["command"], str(item["killed"]), str(item["early"]), str(item["without_rows"]),
                   f"{item['largest_loss_s']:.2f}", f"{item['largest_early_loss_s']:.2f}",
                   str(len(item["wrong"]))] for item in items])
