#!/usr/bin/env python3
"""Overhead of environments in Python: env_speed.py [WORLDS] [STEPS A PERIOD] [ROUNDS]. Prints JSON.

Like benchmarks/environments.cpp, for env_speed.yaml, through `taut.gym` and `taut.Batch`. "bare" is a batch that
receives the same rest lengths and only runs `Batch.step`; the program checks that its worlds have the same bits.
"singles": 64 `taut.gym.Env`, one after the other, gathered in arrays, against 64 worlds of one `VectorEnv`. All
variants take turns of some milliseconds. Results are medians of ratios of processor time, or, for two threads, of
wall-clock time.

Uses the module that `import taut` finds."""
import json
import pathlib
import sys
import time

import numpy as np

import taut
import taut.gym

ROUND_S = 0.01
SETS = 8


def worlds_of(experiment, worlds, threads=1):
    return taut.gym.make_vec(experiment, worlds, threads=threads, randomise=False, copy=False)


class Runner:
    """Runs some periods at a time, with alternating sets of actions."""

    def __init__(self, step, worlds, steps):
        self.step, self.taken = step, 0
        self.periods = max(1, int(ROUND_S / (1e-6 * worlds * steps)))

    def run(self):
        """Returns processor time and wall-clock time per period [s]."""
        self.step(self.taken % SETS)
        worked, wall = time.process_time(), time.perf_counter()
        for i in range(self.periods):
            self.step((self.taken + 1 + i) % SETS)
        worked, wall = time.process_time() - worked, time.perf_counter() - wall
        self.taken += self.periods + 1
        return worked / self.periods, wall / self.periods


def summary(ratios):
    low, middle, high = np.percentile(ratios, [25, 50, 75])
    return {"rounds": len(ratios), "median": round(middle, 3), "quartiles": [round(low, 3), round(high, 3)]}


def main():
    try:
        worlds, steps, rounds = (int(word) for word in [*sys.argv[1:], *["256", "10", "61"][len(sys.argv) - 1:]])
    except ValueError:
        sys.exit(__doc__.split("\n", 1)[0])
    experiment = taut.load(str(pathlib.Path(__file__).with_suffix(".yaml")), period_s=1e-3 * steps)
    many, two = worlds_of(experiment, worlds), worlds_of(experiment, worlds, threads=2)
    singles = [taut.gym.Env(experiment, randomise=False) for _ in range(64)]
    few, bare = worlds_of(experiment, 64), taut.Batch(experiment.robot, worlds=worlds)
    for each in (many, two, few, *singles):
        each.reset(seed=0)
    random = np.random.default_rng(1)
    shape = many.action_space.shape
    actions = (random.integers(-64, 64, (SETS, *shape)) / 128).astype(np.float32)
    targets = np.maximum(bare.rest_length_m() + many.action_scales * actions.astype(float), 0.0)

    seen = np.zeros((64, many.observation_space.shape[1]), np.float32)
    rewards, flags = np.zeros(64), np.zeros((2, 64), bool)

    def each_single(k):  # gathered in arrays as in a VectorEnv
        for i, env in enumerate(singles):
            seen[i], rewards[i], flags[0, i], flags[1, i], _ = env.step(actions[k][i])

    runners = {
        "bare": Runner(lambda k: bare.step(experiment.step_s, steps, targets[k]), worlds, steps),
        "many": Runner(lambda k: many.step(actions[k]), worlds, steps),
        "two": Runner(lambda k: two.step(actions[k]), worlds, steps),
        "few": Runner(lambda k: few.step(actions[k][:64]), 64, steps),
        "singles": Runner(each_single, 64 * 20, steps),
    }
    share, over, gain = [], [], []
    for _ in range(rounds):
        cost = {name: runner.run() for name, runner in runners.items()}
        share.append(cost["bare"][0] / cost["many"][0])
        over.append(cost["singles"][0] / cost["few"][0])
        gain.append(cost["many"][1] / cost["two"][1])
    print(json.dumps({
        "worlds": worlds, "lanes": bare.lanes, "steps_a_period": steps, "actions": shape[1],
        "same_bits": many.hash(worlds - 1) == bare.hash(worlds - 1), "share_of_bare": summary(share),
        "over_singles": summary(over), "two_threads": summary(gain)}, indent=1))


if __name__ == "__main__":
    main()
