"""Domain randomization: displacement of Tetraspine3 by a push, in 64 worlds of random mass, stiffness and friction."""

import numpy as np

import taut

WORLDS, STEP_S = 64, 1e-3
random = np.random.default_rng(1)
experiment = taut.load("experiments/push_20n.yaml")
robot, batch = experiment.robot, taut.Batch(experiment.robot, worlds=WORLDS, threads=0)

friction = random.uniform(0.6, 1.4, WORLDS)  # factors of the ground's friction
batch.set_parameter("friction_scale", friction)
mass_kg = np.array([batch.parameter("body_mass_kg", body) for body in range(len(robot.bodies))])
stiffness_n_per_m = np.array([batch.parameter("cable_stiffness_n_per_m", cable) for cable in range(len(robot.cables))])
mass_kg *= random.uniform(0.9, 1.1, mass_kg.shape)
stiffness_n_per_m *= random.uniform(0.8, 1.2, stiffness_n_per_m.shape)
for body, masses in enumerate(mass_kg):
    batch.set_parameter("body_mass_kg", masses, body)
for cable, stiffnesses in enumerate(stiffness_n_per_m):
    batch.set_parameter("cable_stiffness_n_per_m", stiffnesses, cable)

batch.step(STEP_S, 2000)  # until all worlds are at rest
before = batch.body_position_m()
for world in range(WORLDS):  # pushes the first segment and holds the others back
    for node, force_n in (("segment_0.tip", 20), ("segment_1.tip", -9), ("segment_2.tip", -11)):
        batch.set_node_force(world, robot.nodes.index(node), [force_n, 0, 0])
batch.step(STEP_S, 2000)

moved_mm = 1e3 * (batch.body_position_m() - before)[:, 0, 0]
least, median, most = np.percentile(moved_mm, [5, 50, 95])
print(f"20 N move the first segment by {median:.1f} mm; in 90 of 100 worlds by {least:.1f} to {most:.1f} mm")
for what, values in (("friction", friction), ("mass", mass_kg.sum(axis=0)), ("stiffness", stiffness_n_per_m.mean(axis=0))):
    print(f"correlation with {what:9} {np.corrcoef(values, moved_mm)[0, 1]:+.2f}")
assert not batch.status().any()
