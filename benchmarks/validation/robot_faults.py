"""Faults of a robot's electronics, twenty times each, on emulated boards and the driver."""

import collections
import concurrent.futures
import json
import os
import pathlib
import random
import re
import subprocess

from validation.runs import Problem, fill, table
from validation.virtual_robot import h5py

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
SEED, TIMES = 1, 20
FAULT_S, LOOK_S, GO_ON_S = (0.2, 0.6), 1.4, 2.9  # experiment times; after a fault the PC needs a second for a new setup
RECOVERIES = 5
LIMIT_N = 50  # default of the boards' tension_limit_n
PUSH, GAIT = "push_20n_motors", "sine_hand_tuned_motors"
BOARD, CABLE = "board: {board}", "cable: {cable}"
FAULTS = (  # name for readers, entry in a fault script, experiment, whether operation can continue afterwards
    ("broadcasts lost for 25 ms", "host_killed, for_s: 0.025", PUSH, True),
    ("broadcasts lost for 60 ms", "host_killed, for_s: 0.06", PUSH, True),
    ("PC hangs for 0.4 s", "host_killed, for_s: 0.4", PUSH, True),
    ("PC killed", "host_killed", PUSH, False),
    ("USB pulled out for 0.3 s", "usb_loss, for_s: 0.3", PUSH, True),
    ("USB pulled out", "usb_loss", PUSH, False),
    ("board without power for 0.2 s", f"board_loss, for_s: 0.2, {BOARD}", PUSH, True),
    ("board gone", f"board_loss, {BOARD}", PUSH, False),
    ("brown-out of 20 ms", f"brown_out, for_s: 0.02, {BOARD}", PUSH, True),
    ("firmware hangs", f"firmware_hang, {BOARD}", PUSH, True),
    ("bus noise, 1 bit in 10 000, 0.5 s", "bus_noise, for_s: 0.5, flips_per_bit: 1e-4", PUSH, True),
    ("bus noise, 1 bit in 1 000, 0.5 s", "bus_noise, for_s: 0.5, flips_per_bit: 1e-3", PUSH, True),
    ("illegal start on the bus", "bus_error", PUSH, True),
    ("data line low for 20 ms", "bus_stuck, for_s: 0.02, line: data", PUSH, True),
    ("data line low for 0.3 s", "bus_stuck, for_s: 0.3, line: data", PUSH, True),
    ("clock line low for 0.3 s", "bus_stuck, for_s: 0.3, line: clock", PUSH, True),
    ("cable cut", f"cut_cable, {CABLE}", PUSH, False),
    ("load cell stuck, robot at rest", f"stuck_load_cell, for_s: 1, {CABLE}", PUSH, True),
    ("load cell stuck, robot walks", f"stuck_load_cell, for_s: 1, {CABLE}", GAIT, True),
    ("load cell shows 0 N", f"stuck_load_cell, for_s: 1, force_n: 0, {CABLE}", PUSH, True),
    ("load cell shows -5 N (wire off)", f"stuck_load_cell, for_s: 1, force_n: -5, {CABLE}", PUSH, True),
    ("load cell shows 60 N", f"stuck_load_cell, for_s: 1, force_n: 60, {CABLE}", PUSH, True),
    ("encoder stuck, robot at rest", f"stuck_encoder, for_s: 1, {CABLE}", PUSH, True),
    ("encoder stuck, robot walks", f"stuck_encoder, for_s: 1, {CABLE}", GAIT, True),
    ("driver fault for 0.1 s", f"driver_fault, for_s: 0.1, {BOARD}", PUSH, True),
    ("no supply of the motors for 0.3 s", "motor_supply_loss, for_s: 0.3", PUSH, True),
    ("clock 0.5 % fast", f"clock_drift, drift_ppm: 5000, {BOARD}", PUSH, True),
)
COUNTS = ("bad_frames", "bad_messages", "late_ticks", "missed_broadcasts", "bus_recoveries")
LINK_COUNTS = ("late_cycles", "silent_transfers", "unheard_broadcasts", "failed_group_reads", "adapter_resets", "reconnections")
MODES = {0: "off", 1: "hold", 2: "position", 3: "impedance", 7: "stopped"}


def generalised(text, cables):
    """Returns a message without the names of boards and cables."""
    text = re.sub(r"board \d", "a board", text)
    for cable in sorted(cables, key=len, reverse=True):
        text = text.replace(cable, "a cable")
    return text


class Run:
    """Reaction to a fault, from the files of a run."""

    def __init__(self, folder):
        events = [json.loads(line) for line in (folder / "events.jsonl").read_text().splitlines()]
        figures = json.loads((folder / "boards.json").read_text())
        self.largest_n, self.recovered = figures["largest_tension_n"], figures["recovered"]
        begun = [e["time_s"] for e in events if e["who"] == "fault" and e["what"].endswith("begins")]
        self.begun_s = begun[0]
        told = [e for e in events if e["who"] == "pc" and self.begun_s <= e["time_s"] < LOOK_S]
        self.before = [e["what"] for e in events if e["who"] == "pc" and 0.05 < e["time_s"] < self.begun_s]
        with h5py().File(folder / "host.h5", "r") as host:
            self._heard(host)
            cables = [name for name in host["cable"]]
        self.told = list(dict.fromkeys(generalised(e["what"], cables) for e in told if " -> " not in e["what"]))
        seen = [e["time_s"] - self.begun_s for e in told] + ([self.counted_s] if self.counted_s is not None else [])
        self.noticed_s = min(seen, default=None)
        with h5py().File(folder / "trace.h5", "r") as trace:
            time_s = trace["time_s"][:]
            before, after = (time_s <= self.begun_s).nonzero()[0][-1], (time_s <= LOOK_S - 0.01).nonzero()[0][-1]
            sums = sum(trace[f"cable/{cable}/tension_n"][:] for cable in cables)
            self.left = sums[after] / sums[before]

    def _heard(self, host):
        time_s = host["time_s"][:]
        rows = (time_s >= self.begun_s).nonzero()[0]
        first = rows[0] - 1 if len(rows) else len(time_s) - 1
        last = (time_s <= LOOK_S - 0.01).nonzero()[0][-1]
        boards = list(host["board"])
        self.modes = {MODES[int(host[f"board/{b}/mode"][last])] for b in boards
                      if not int(host[f"board/{b}/state"][last]) & 32}
        self.well = all(int(host[f"board/{b}/mode"][-1]) == 3 and not int(host[f"board/{b}/state"][-1]) & 38 for b in boards)
        rows = {}
        for what, paths in [(w, [f"board/{b}/{w}" for b in boards]) for w in COUNTS] + [(w, [f"link/{w}"]) for w in LINK_COUNTS]:
            for path in paths:
                values = host[path][first:last + 1]
                changed = (values[1:] > values[:-1]).nonzero()[0]
                if len(changed):
                    rows[what] = min(rows.get(what, last), first + 1 + changed[0])
        self.counted = list(rows)
        self.counted_s = max(0.0, float(time_s[min(rows.values())]) - self.begun_s) if rows else None


class Boards:
    def __init__(self, taut):
        self.taut, self.command = taut, pathlib.Path(taut.command).parent / "taut_virtual_robot"
        if not os.access(self.command, os.X_OK):
            raise Problem(f"there is no {self.command}: it wants gcc-avr, avr-libc and libsimavr-dev")

    def run(self, job):
        name, script, experiment, seed, goes_on = job
        folder = self.taut.folder / re.sub(r"\W+", "_", name) / str(seed)
        folder.mkdir(parents=True, exist_ok=True)
        flags = ["--duration_s", str(GO_ON_S if goes_on else LOOK_S), *(["--recover_s", str(LOOK_S)] if goes_on else [])]
        if script:
            (folder / "faults.yaml").write_text(f"taut: 1\nkind: faults\nname: one\nfaults:\n  - {script}\n")
            flags += ["--faults", folder / "faults.yaml"]
        done = subprocess.run([self.command, "--experiment", f"experiments/{experiment}.yaml", "--run", "--quiet", "--seed",
                               str(seed + 1), "--out", folder, *flags],
                              capture_output=True, text=True)
        if done.returncode != 0:
            raise Problem(f"{name}: {done.stdout}{done.stderr}")
        return job, folder


def often(runs, texts):
    """Returns the texts of all runs in order of appearance, with the number of runs of each."""
    counted = collections.Counter(text for run in runs for text in texts(run))
    return "; ".join(text if n == len(runs) else f"{text} ({n})" for text, n in counted.items())


def row(name, goes_on, runs):
    noticed = [run.noticed_s for run in runs if run.noticed_s is not None]
    modes = collections.Counter(" and ".join(sorted(run.modes)) or "no board answers" for run in runs)
    back = sum(run.recovered and run.well for run in runs[:RECOVERIES])
    return [name, often(runs, lambda run: run.told) or "none", often(runs, lambda run: run.counted) or "none",
            f"{len(noticed)}" + (f", {1e3 * max(noticed):.0f} ms" if noticed else ""),
            "; ".join(f"{mode} ({n})" if n < len(runs) else mode for mode, n in modes.items()),
            f"{100 * min(run.left for run in runs):.0f} to {100 * max(run.left for run in runs):.0f} %",
            f"{max(run.largest_n for run in runs):.1f}", f"{back} of {min(RECOVERIES, len(runs))}" if goes_on else "-"]


def page(taut):
    boards = Boards(taut)
    plain = boards.run(("nothing", "", PUSH, 0, False))[1]
    started_s = {PUSH: json.loads((plain / "boards.json").read_text())["started_s"]}
    walk = boards.run(("nothing, walking", "", GAIT, 0, False))[1]
    started_s[GAIT] = json.loads((walk / "boards.json").read_text())["started_s"]
    with h5py().File(plain / "host.h5", "r") as host:
        cables = list(host["cable"])
    draw, jobs = random.Random(SEED), []
    for name, script, experiment, goes_on in FAULTS:
        for seed in range(TIMES):
            at_s = started_s[experiment] + draw.uniform(*FAULT_S)
            entry = script.format(board=draw.randrange(6), cable=draw.choice(cables))
            jobs.append((name, f"{{at_s: {at_s:.6f}, kind: {entry}}}", experiment, seed, goes_on and seed < RECOVERIES))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        folders = list(pool.map(boards.run, jobs))
    runs = collections.defaultdict(list)
    for (name, *_), folder in folders:
        runs[name].append(Run(folder))
    early = [text for name in runs for run in runs[name] for text in run.before]
    if early:
        raise Problem(f"something was told before anything went wrong: {early[0]}")
    silent = [f"{name} ({sum(run.noticed_s is None for run in runs[name])})"
              for name, *_ in FAULTS if any(run.noticed_s is None for run in runs[name])]
    worst = max((max(run.largest_n for run in runs[name]), name) for name, *_ in FAULTS)
    return fill(TEMPLATE.read_text(), {
        "times": str(TIMES), "kinds": str(len(FAULTS)), "runs": str(len(jobs)), "limit": str(LIMIT_N),
        "plain": f"{json.loads((plain / 'boards.json').read_text())['largest_tension_n']:.1f}",
        "walk": f"{json.loads((walk / 'boards.json').read_text())['largest_tension_n']:.1f}",
        "table": table(["fault", "PC events (number of runs, if not all)", "counters that grew", "runs noticed, longest delay",
                        "mode of the boards", "tension left", "largest tension [N]", "runs recovered"],
                       [row(name, goes_on, runs[name]) for name, _, _, goes_on in FAULTS]),
        "silent": ", ".join(silent) or "none", "worst": f"{worst[0]:.1f} N ({worst[1]})",
        "over": "none" if worst[0] <= LIMIT_N else f"{sum(run.largest_n > LIMIT_N for name in runs for run in runs[name])}"})
