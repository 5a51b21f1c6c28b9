"""Comparison of a deterministic policy of ppo.py with the best sine gait: same starts, ground, motors and time.

The sine is gaits/roll_six_strut.yaml, which `taut learn studies/roll_six_strut.yaml` found. The starts equal those
of docs/validation/rolling.md, so that its table and this program show the same distances.
"""

import csv
import math
import os
import pathlib
import random
import statistics

import torch

import taut
import taut.gym

EXPERIMENTS = pathlib.Path(__file__).resolve().parents[1] / "share/experiments"
SINE, PLAIN = EXPERIMENTS / "roll_six_strut.yaml", EXPERIMENTS / "roll_six_strut_start.yaml"


def write_start(path, base, number, seconds, more=""):
    """Writes an experiment with the start of run `number` of docs/validation/rolling.md: the first is as described, the
    others have slightly different positions and ground friction. `more`: further keys."""
    if number:
        more += (f"parameters: {{ground_friction: {random.Random(number).uniform(0.4, 0.6):.4f}}}\nseed: {number}\n"
                 "start_noise: {position_m: 0.01, heading_rad: 0.1}\n")
    path.write_text(f"taut: 1\nkind: experiment\nbase: {os.path.relpath(base, path.parent)}\nname: {path.stem}\n"
                    f"duration_s: {seconds}\n{more}")
    return str(path)


def roll(policy, task, number, seconds, folder, more=""):
    """Returns the distance [m] of the deterministic policy; writes an experiment that replays its commands."""
    name = f"policy_{number}"
    envs = taut.gym.make_vec(write_start(folder / f"{name}.yaml", task, number, seconds, more), 1, randomise=False)
    at, over, rows = [envs.observation_channels.index(f"system/com_{k}_m") for k in "xy"], False, []
    observations, _ = envs.reset(seed=number)
    start_m = observations[0, at]
    while not over:
        with torch.no_grad():
            actions = policy(policy.scaled(policy.look(observations))).mean.clamp(-1, 1).numpy()
        rows.append([len(rows) * envs.period_s, *(actions[0].astype(float) * envs.action_scales).tolist()])
        observations, _, failed, cut, _ = envs.step(actions)
        over = failed[0] or cut[0]
    with open(folder / f"{name}.csv", "w", newline="") as file:
        csv.writer(file).writerows([["time_s"] + [c.split("/")[1] + "_m" for c in envs.action_channels], *rows])
    gait = f"taut: 1\nkind: gait\nname: {name}\ndrives: rest_length\ntable: {{file: {name}.csv}}\n"
    (folder / f"{name}_gait.yaml").write_text(gait)
    clock = f"rest_length_input: {{gait: {name}_gait.yaml, period_s: {envs.period_s}}}"
    write_start(folder / f"{name}.yaml", PLAIN, number, seconds,
                f"{more}controllers: [{{name: motion, period_s: 0.001, {clock}}}]\n")
    return math.hypot(*(observations[0, at] - start_m))


def roll_by_sine(number, seconds, folder, more=""):
    com = taut.run(taut.load(write_start(folder / f"sine_{number}.yaml", SINE, number, seconds, more))).trace
    return math.hypot(*(com[f"system/com_{k}_m"][-1] - com[f"system/com_{k}_m"][0] for k in "xy"))


def beside_the_sine(policy, task, folder, seconds, starts):
    folder.mkdir(parents=True, exist_ok=True)
    print(f"metres in {seconds:g} s\nstart  policy    sine")
    ways = []
    for number in range(starts):
        ways.append((roll(policy, task, number, seconds, folder), roll_by_sine(number, seconds, folder)))
        print("{:5d} {:7.1f} {:7.1f}".format(number, *ways[-1]), flush=True)
    for name, of in ("least", min), ("median", statistics.median), ("most", max):
        print("{:>6}{:7.1f} {:7.1f}".format(name, *map(of, zip(*ways))))
    print(f"to look at: taut view {folder}/policy_0.yaml, {folder}/sine_0.yaml")
