"""Model-predictive control (MPC): a six-strut robot rolls towards +x by commands that are optimized in 64 worlds.

Every 0.4 s the cross-entropy method optimizes the rest lengths of the next 0.8 s, without a gait, in worlds that start
in the robot's present state.
"""

import numpy as np

import taut

WORLDS, ROUNDS, ELITE = 64, 3, 8
STEP_S, TICK = 1e-3, 20    # commands of the winches change every 20 ms
AHEAD, TAKEN = 40, 20      # ticks of the horizon, and ticks that are executed
FASTEST_M_PER_S = 0.5      # of a winch
SHARE = 0.35              # largest reduction of rest lengths from the state at rest

random = np.random.default_rng(0)
experiment = taut.load("experiments/roll_six_strut.yaml")
standing = taut.analyze(experiment).robot
robot, tried = taut.Batch(standing), taut.Batch(standing, worlds=WORLDS, threads=0)
rest_m = robot.rest_length_m()[0]


def targets_of(wound, now_m):
    """Returns rest lengths per tick from wound-in shares, 0..1, for both halves of the horizon, limited by the
    winches' speed from `now_m`."""
    wished_m, targets_m = rest_m * (1 - SHARE * wound), []
    for tick in range(AHEAD):
        step_m = wished_m[:, 0 if tick < AHEAD // 2 else 1] - now_m
        now_m = now_m + np.clip(step_m, -FASTEST_M_PER_S * TICK * STEP_S, FASTEST_M_PER_S * TICK * STEP_S)
        targets_m.append(now_m)
    return np.stack(targets_m, axis=1)


def x_of(positions_m):
    """Returns x of the center of mass; all struts have the same mass."""
    return positions_m[..., 0].mean(axis=-1)


def look_ahead(mean):
    """Returns the best wound-in shares found from the present state."""
    start, now_m = robot.save(), robot.rest_length_target_m()
    spread, best, best_x = np.full(mean.shape, 0.5), mean, -np.inf
    for _ in range(ROUNDS):
        wound = np.clip(random.normal(mean, spread, (WORLDS, *mean.shape)), 0, 1)
        wound[0] = best
        x_m = x_of(tried.rollout(targets_of(wound, now_m), STEP_S, TICK, start)[:, -1])
        x_m[tried.status() != 0] = -np.inf
        order = np.argsort(-x_m)
        if x_m[order[0]] > best_x:
            best, best_x = wound[order[0]], x_m[order[0]]
        mean, spread = wound[order[:ELITE]].mean(axis=0), wound[order[:ELITE]].std(axis=0) + 0.05
    return best


wound = np.full((2, len(rest_m)), 0.2)
begin_m = x_of(robot.body_position_m()[0])
for look in range(15):
    wound = look_ahead(wound)
    robot.rollout(targets_of(wound[None], robot.rest_length_target_m())[:, :TAKEN], STEP_S, TICK)
    wound = wound[[1, 1]]
    if look % 3 == 2:
        print(f"{robot.time_s()[0]:4.1f} s: {x_of(robot.body_position_m()[0]) - begin_m:6.3f} m")
assert not robot.status().any()

experiment.duration_s = robot.time_s()[0]
trace = taut.run(experiment).trace
way_m = np.hypot(*(np.ptp(trace[f"system/com_{axis}_m"][[0, -1]]) for axis in "xy"))
print(f"by the gait that taut has learned, with winches as fast: {way_m:.3f} m, in a direction of its own")
