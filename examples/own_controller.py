"""A controller in Python: the winch damps the vertical oscillation of a mass on a cable."""

import math

import numpy as np

import taut

MASS_KG, STIFFNESS_N_PER_M, STEP_S = 0.5, 400.0, 1e-3
DAMPING_N_S_PER_M = 4.0  # simulated by the winch: winds in proportion to the shortening

batch = taut.Batch(taut.load("examples/winch.yaml"), worlds=2)  # world 0 without the controller, world 1 with it
rest_m = batch.rest_length_m()
height_m = []
for step in range(1500):
    target_m = rest_m.copy()
    target_m[1] -= DAMPING_N_S_PER_M / STIFFNESS_N_PER_M * batch.cable_rate_m_per_s()[1]
    batch.step(STEP_S, 1, target_m)
    height_m.append(batch.node_position_m()[:, 1, 2])

hangs_m = 2 - 1 - MASS_KG * 9.81 / STIFFNESS_N_PER_M
swing_mm = 1e3 * np.abs(np.array(height_m) - hangs_m)
for name, swing in zip(("without", "with"), swing_mm.T):
    print(f"{name:8} {swing[:250].max():6.3f} mm in the first quarter of a second, {swing[-250:].max():6.3f} mm from 1.25 s on")
by_hand_mm = 10 * math.exp(-DAMPING_N_S_PER_M / MASS_KG / 2 * 1.25)
print(f"by hand         a damper of {DAMPING_N_S_PER_M:g} N s/m would leave {by_hand_mm:6.3f} mm at most")
