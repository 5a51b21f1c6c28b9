"""Plants in Python, and recordings as plants

plant_test.py TAUT [unittest's arguments]
"""

import pathlib
import sys
import unittest

import numpy as np

import taut

ROOT = pathlib.Path(__file__).resolve().parents[2]
PUSH = str(ROOT / "share/experiments/push_20n.yaml")


def push(seconds):
    experiment = taut.load(PUSH)
    experiment.duration_s = seconds
    return experiment


class Springs:
    """Cables that end at walls: a plant in Python."""

    def __init__(self, robot):
        count = len(robot.cables)
        self.rest_m, self.length_m = np.full(count, 0.2), np.full(count, 0.25)
        self.steps, self.broken = 0, False

    def observe(self):
        return {"rest_length_m": self.rest_m, "cable_length_m": self.length_m, "cable_rate_m_per_s": 0 * self.rest_m,
                "tension_n": 100 * (self.length_m - self.rest_m)}

    def advance(self, step_s, time_s, commands):
        self.steps += 1
        if self.broken and time_s > 0.05:
            raise OSError("the bus is silent")
        self.rest_m = self.rest_m + np.clip(commands.rest_length_m - self.rest_m, -0.1 * step_s, 0.1 * step_s)


class Plants(unittest.TestCase):
    def test_the_experiments_controllers_act_on_a_plant_in_python(self):
        experiment = push(0.2)
        plant = Springs(experiment.robot)
        ran = taut.run(experiment, plant=plant)
        self.assertGreaterEqual(plant.steps, 200)
        self.assertAlmostEqual(ran.simulated_s, 0.2)
        self.assertNotAlmostEqual(plant.rest_m[0], 0.2, places=4)
        self.assertEqual(ran.trace["cable/outer_top_1/rest_length_m"][-1], plant.rest_m[experiment.robot.cables.index("outer_top_1")])
        plant.broken = True
        with self.assertRaisesRegex(OSError, "the bus is silent"):
            taut.run(experiment, plant=plant)
        self.assertRaises(TypeError, taut.run, experiment, plant=3)
        with self.assertRaisesRegex(ValueError, "tension_n"):
            taut.run(experiment, plant=type("Short", (), {"observe": lambda self: {
                "rest_length_m": plant.rest_m, "cable_length_m": plant.rest_m, "cable_rate_m_per_s": plant.rest_m,
                "tension_n": [1.0]}, "advance": lambda *_: None})())

    def test_a_recording_is_a_plant(self):
        experiment = push(0.3)
        recorded = taut.run(experiment).trace
        replayed = taut.run(experiment, plant=taut.Replay(recorded)).trace
        name = "cable/outer_top_1/tension_n"
        np.testing.assert_allclose(replayed[name][:20], recorded[name][:20])
        with self.assertRaises(taut.InputError):
            taut.run(taut.load(str(ROOT / "share/experiments/hang.yaml")), plant=taut.Replay(recorded))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
