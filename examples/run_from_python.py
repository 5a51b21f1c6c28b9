"""Runs from Python: displacement and largest tension of Tetraspine3 in a push of 10 s, on two kinds of ground."""

import taut

for friction in (0.15, 0.6):
    experiment = taut.load("experiments/push_20n.yaml", ground_friction=friction)
    experiment.duration_s = 10
    ran = taut.run(experiment)
    x_m = ran.trace["system/com_x_m"]
    cable, most_n = max(ran.max_tension_n.items(), key=lambda item: item[1])
    print(f"friction {friction:4}: {1e3 * (x_m[-1] - x_m[0]):6.2f} mm, {most_n:.2f} N in {cable}")
