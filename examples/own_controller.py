"""A controller in Python: the winch damps the vertical oscillation of a mass on a cable."""

import math

import numpy as np

import taut

MASS_KG, STIFFNESS_N_PER_M = 0.5, 400.0
DAMPING_N_S_PER_M = 4.0  # simulated by the winch: winds in proportion to the shortening


class Damper:
    period_s = 0.001

    def act(self, seen, commands):
        gain = np.where(seen.world == 1, DAMPING_N_S_PER_M / STIFFNESS_N_PER_M, 0)[:, None]  # in world 1 only
        commands.rest_length_m[:] = 1 - gain * seen.cable_rate_m_per_s


sim = taut.Simulation("examples/winch.yaml", worlds=2, controllers=[Damper()])
height_m = []
for step in range(1500):
    sim.step()
    height_m.append(sim.node_position_m("mass")[:, 2])

hangs_m = 2 - 1 - MASS_KG * 9.81 / STIFFNESS_N_PER_M
swing_mm = 1e3 * np.abs(np.array(height_m) - hangs_m)
for name, swing in zip(("without", "with"), swing_mm.T):
    print(f"{name:8} {swing[:250].max():6.3f} mm in the first quarter of a second, {swing[-250:].max():6.3f} mm from 1.25 s on")
by_hand_mm = 10 * math.exp(-DAMPING_N_S_PER_M / MASS_KG / 2 * 1.25)
print(f"by hand         a damper of {DAMPING_N_S_PER_M:g} N s/m would leave {by_hand_mm:6.3f} mm at most")
