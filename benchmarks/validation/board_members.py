"""Simulates the paper's robot on motor boards with random values of unpublished numbers.

Usage: board_members.py COUNT FOLDER; writes FOLDER/members.json: COUNT members, and half as many near the best. virtual_robot_band.py starts it with the Python
module of the same build.
"""

import concurrent.futures
import json
import math
import os
import pathlib
import random
import sys

import numpy as np
import taut

from board_facts import DRIVES, RANGES, misfit

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARE = ROOT / "share"
LANES = 8
READ_S = 0.02
FROM_S = 5.0  # statistics of tensions exclude the start
HOLD_S = 2.0  # duration of position control before T0 and L0 are captured

# Experiments, and factors on the amplitude. On the robot, the amplitudes of the sine waves were ten times those of the
# simulator (Mirletz et al. 2015, section V).
RUNS = {"push": ("push_20n", 1), "sine": ("sine_hand_tuned", 10), "gait": ("cpg_learned", 1)}


def draw(count, seed=1):
    """Returns members: drive, capture, and a value of each range."""
    numbers = random.Random(seed)
    drives = list(DRIVES)
    return [{"drive": drives[i // LANES % len(drives)], "capture": i // LANES // len(drives) % 6 == 5,
             "values": {name: math.exp(numbers.uniform(math.log(low), math.log(high)))
                        for name, (low, high) in RANGES.items()}} for i in range(count)]


def refine(members, count, seed):
    """Returns members with values near those of the least misfit, the same number for each drive."""
    numbers = random.Random(seed)
    refined = []
    for first in range(0, count, LANES):
        drive = list(DRIVES)[first // LANES % len(DRIVES)]
        of_drive = [member for member in members if member["drive"] == drive and not member["capture"]]
        parents = sorted(of_drive, key=misfit)[:LANES]
        for parent in parents:
            values = {name: min(high, max(low, parent["values"][name] * math.exp(numbers.gauss(0, 0.2))))
                      for name, (low, high) in RANGES.items()}
            refined.append({"drive": drive, "capture": False, "values": values})
    return refined


def write_experiment(folder, run, drive, capture):
    """Writes the experiment of a run with a drive on boards; returns its path."""
    gear, motor = DRIVES[drive]
    name = f"{run}_{list(DRIVES).index(drive)}_{int(capture)}"
    model = (SHARE / "models/tetraspine3_motors.yaml").read_text()
    model = model.replace("base: tetraspine3.yaml", f"base: {SHARE}/models/tetraspine3.yaml")
    if motor:
        model = model.replace("  dc_motor:\n", f"  dc_motor:\n    {motor}\n")
    (folder / f"{name}_model.yaml").write_text(model)
    text = [f"taut: 1\nkind: experiment\nname: {name}\nbase: {SHARE}/experiments/{RUNS[run][0]}.yaml",
            f"model: {name}_model.yaml"]
    if gear:
        text.append(f"set: {{{gear}}}")
    text.append(f"boards: {{hold_s: {HOLD_S}, capture: true}}" if capture else "boards: {}")
    path = folder / f"{name}.yaml"
    path.write_text("\n".join(text) + "\n")
    return path


def variant_of(member, run):
    values = dict(member["values"])
    values["boards.force_i_per_n_s"] = values["boards.force_p_per_n"] / values.pop("integral_s")
    values["boards.velocity_input_scale"] *= RUNS[run][1]
    return values


def figures_of(sim, duration_s):
    """Runs a simulation to its end; returns the figures of each world."""
    outer = [i for i, name in enumerate(sim.cables) if name.startswith("outer")]
    start_m = sim.body_position_m().mean(axis=1)
    largest, total, total_outer, rows = np.zeros(sim.worlds), 0.0, 0.0, 0
    for tick in range(1, round(duration_s / READ_S) + 1):
        sim.run_until(tick * READ_S)
        if tick * READ_S <= FROM_S:
            continue
        tension_n = sim.tension_n()
        largest = np.maximum(largest, tension_n.max(axis=1))
        total = total + tension_n.mean(axis=1)
        total_outer = total_outer + tension_n[:, outer].mean(axis=1)
        rows += 1
    way_m = sim.body_position_m().mean(axis=1) - start_m
    return [{"max_n": float(largest[i]), "mean_n": float(total[i] / rows), "outer_n": float(total_outer[i] / rows),
             "way_m": [float(x) for x in way_m[i, :2]]} for i in range(sim.worlds)]


def simulate(job):
    """Runs one group of members; returns their figures."""
    path, run, members = job
    experiment = taut.load(str(path))
    sim = taut.Simulation(experiment, variants=[variant_of(member, run) for member in members], threads=1)
    return figures_of(sim, experiment.duration_s)


def reference(run):
    """Returns the figures of the pure simulation."""
    experiment = taut.load(str(SHARE / f"experiments/{RUNS[run][0]}.yaml"))
    return figures_of(taut.Simulation(experiment, threads=1), experiment.duration_s)[0]


def complete(members, folder):
    """Simulates members and adds their figures."""
    jobs, places = [], []
    for first in range(0, len(members), LANES):
        group = members[first:first + LANES]
        for run in RUNS:
            jobs.append((write_experiment(folder, run, group[0]["drive"], group[0]["capture"]), run, group))
            places.append((first, run))
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count()) as pool:
        for done, ((first, run), figures) in enumerate(zip(places, pool.map(simulate, jobs)), 1):
            for member, of_member in zip(members[first:first + LANES], figures):
                member[run] = of_member
            print(f"\r{done} of {len(jobs)} groups", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)


def main():
    count, folder = int(sys.argv[1]), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    members = draw(count)
    complete(members, folder)
    known = list(members)
    refined = []
    for stage in range(2, 4):
        more = refine(known, count // 4 // LANES * LANES, seed=stage)
        complete(more, folder)
        refined += more
        known += more
    pure = {run: reference(run) for run in RUNS}
    (folder / "members.json").write_text(json.dumps({"pure": pure, "members": members, "refined": refined}, indent=1))


if __name__ == "__main__":
    main()
