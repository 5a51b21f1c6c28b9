"""taut.Simulation and controllers in Python: bits of runs, errors of wrong calls

simulation_test.py TAUT [unittest's arguments]
"""

import pathlib
import sys
import unittest
import warnings

import numpy as np

import taut

ROOT = pathlib.Path(__file__).resolve().parents[2]
PUSH = str(ROOT / "share/experiments/push_20n.yaml")
GAIT = str(ROOT / "share/experiments/cpg_learned.yaml")
PRISM = str(ROOT / "share/models/prism3.yaml")


def push(seconds):
    experiment = taut.load(PUSH)
    experiment.duration_s = seconds
    return experiment


class OwnImpedance:
    """The law of the paper (eq. 3) in numpy, in the order of the C++ law's operations."""

    period_s = 0.001
    stateless = True

    def __init__(self, gains):
        names = ("tension_offset_n", "length_offset_m", "position_gain_n_per_m", "velocity_gain_n_s_per_m",
                 "velocity_offset_m_per_s")
        self.t0, self.l0, self.k, self.b, self.v0 = (np.array([one[name] for one in gains]) for name in names)

    def act(self, seen, commands):
        length, rate = seen.cable_length_m, seen.cable_rate_m_per_s
        wanted = np.maximum(0.0, self.t0 + self.k * (length - self.l0) + self.b * (rate - self.v0))
        commands.set_point_n[:] = wanted
        commands.velocity_input_m_per_s[:] = self.v0
        commands.rest_length_m[:] = np.maximum(0.0, seen.rest_length_m - (wanted - seen.elastic_n) / seen.stiffness_n_per_m)


class Bits(unittest.TestCase):
    def test_a_simulation_has_the_bits_of_the_run(self):
        sim = taut.Simulation(PUSH)
        sim.run_until(0.5)
        self.assertEqual(sim.hash(), taut.run(push(0.5)).state_hash)
        # A batch of the same model without controllers would have 3.0 N.
        sim.run_until(1.0)
        self.assertAlmostEqual(sim.tension_n("outer_right_1")[0], 6.87, delta=0.01)

    def test_variants_have_the_bits_of_rollouts(self):
        experiment = taut.load(GAIT)
        experiment.duration_s = 0.3
        variants = [{"model.stiffness": 0.9 + 0.05 * i, "seed": 3 + i} for i in range(6)]
        scored = taut.rollout(experiment, "distance", variants)
        sim = taut.Simulation(experiment, variants=variants, threads=2)
        sim.run_until(0.3)
        self.assertEqual([sim.hash(w) for w in range(6)], list(scored["state_hash"]))

    def test_the_library_drives_the_push_test_from_python(self):
        experiment = push(0.8)
        expected = taut.run(experiment).state_hash
        sim = taut.Simulation(experiment.without_controllers(), controllers=experiment.controllers)
        sim.run_until(0.8)
        self.assertEqual(sim.hash(), expected)
        ran = taut.run(experiment.without_controllers(), controllers=experiment.controllers)
        self.assertEqual(ran.state_hash, expected)

    def test_a_controller_in_python_drives_the_push_test_with_the_bits_of_the_library(self):
        experiment = push(0.4)
        sim = taut.Simulation(experiment)
        gains = [sim.gains(cable) for cable in sim.cables]
        self.assertTrue(all(gains))
        sim.run_until(0.4)
        own = taut.Simulation(experiment.without_controllers(), controllers=[OwnImpedance(gains)])
        own.run_until(0.4)
        self.assertEqual(own.hash(), sim.hash())
        self.assertEqual(taut.run(experiment.without_controllers(), controllers=[OwnImpedance(gains)]).state_hash, sim.hash())

    def test_impedance_by_numbers_is_the_controller_of_the_file(self):
        experiment = push(0.4)
        sim = taut.Simulation(experiment)
        gains = [sim.gains(cable) for cable in sim.cables]
        arrays = {name: [one[name] for one in gains] for name in gains[0]}
        made = taut.control.impedance(experiment.robot, **arrays, period_s=experiment.controllers[0].period_s)
        own = taut.Simulation(experiment.without_controllers(), controllers=[made])
        sim.run_until(0.4)
        own.run_until(0.4)
        self.assertEqual(own.hash(), sim.hash())

    def test_save_restore_and_reset(self):
        sim = taut.Simulation(PUSH, worlds=3)
        sim.run_until(0.2)
        saved = sim.save(1)
        sim.run_until(0.3)
        expected = sim.hash(1)
        sim.restore(saved)
        self.assertTrue(np.allclose(sim.time_s(), 0.2))
        sim.run_until(0.3)
        self.assertEqual([sim.hash(w) for w in range(3)], [expected] * 3)
        sim.reset(2)
        self.assertEqual(sim.time_s()[2], 0)
        sim.run_until(0.3)
        self.assertEqual(sim.hash(2), expected)
        with self.assertRaises(taut.InputError) as caught:
            taut.Simulation(GAIT).restore(saved)
        self.assertEqual(caught.exception.items[0].id, "snapshot.other_environment")


    def test_all_worlds_are_reset_in_groups_of_any_size(self):
        for worlds in (1, 2, 3, 5, 8, 9):
            sim = taut.Simulation(PUSH, worlds)
            sim.run_until(0.02)
            ends = [sim.hash(world) for world in range(worlds)]
            sim.reset()
            sim.run_until(0.02)
            self.assertEqual([sim.hash(world) for world in range(worlds)], ends)


class Access(unittest.TestCase):
    def test_shapes_names_and_errors(self):
        sim = taut.Simulation(PUSH, worlds=2)
        self.assertEqual(sim.tension_n().shape, (2, len(sim.cables)))
        self.assertEqual(sim.tension_n(3).shape, (2,))
        self.assertEqual(sim.body_position_m().shape, (2, len(sim.bodies), 3))
        self.assertEqual(sim.node_position_m(sim.nodes[0]).shape, (2, 3))
        self.assertEqual(sim.row().shape, (len(sim.channels),))
        self.assertEqual(sim.status(), "")
        self.assertTrue(sim.is_running().all())
        with self.assertRaises(KeyError) as caught:
            sim.tension_n("outer_rihgt_1")
        self.assertIn('did you mean "outer_right_1"?', str(caught.exception))
        for wrong in (lambda: sim.tension_n(99), lambda: sim.hash(2), lambda: sim.joint(0)):
            self.assertRaises(IndexError, wrong)
        for wrong in (lambda: sim.run_until(float("nan")), lambda: sim.step(-1), lambda: sim.set_rest_length(0, -1),
                      lambda: taut.Simulation(PUSH, worlds=0), lambda: taut.Simulation(PUSH, variants=[]),
                      lambda: sim.set_node_force(0, [0, 0, float("inf")]),
                      lambda: sim.set_gains(0, tension_offset_n=-1),
                      lambda: taut.Simulation(PUSH, threads=2, controllers=[OwnImpedance([])])):
            self.assertRaises(ValueError, wrong)
        self.assertRaises(TypeError, lambda: sim.set_gains(0, stiffness=1))
        with self.assertRaises(taut.InputError) as caught:
            taut.Simulation(PUSH, variants=[{"model.friktion": 1}, {"nothing": 2}])
        self.assertEqual(len(caught.exception.items), 2)
        self.assertIn("variants[0]: there is no parameter", str(caught.exception))

    def test_commands_gains_and_forces_act_in_their_world(self):
        sim = taut.Simulation(PUSH, worlds=3)
        gains = sim.gains("outer_top_1")
        sim.set_gains("outer_top_1", 1, tension_offset_n=gains["tension_offset_n"] + 2)
        self.assertEqual(sim.gains("outer_top_1", 0), gains)
        sim.set_node_force(sim.nodes[0], [0, 0, 1], world=2)
        sim.run_until(0.1)
        self.assertEqual(len({sim.hash(w) for w in range(3)}), 3)
        standing = taut.Simulation(PRISM, worlds=2)
        standing.set_rest_length(standing.cables[0], 0.1, world=1)
        self.assertEqual(standing.rest_length_command_m(0)[1], 0.1)
        self.assertNotEqual(standing.rest_length_command_m(0)[0], 0.1)

    def test_a_batch_warns_of_what_it_leaves_out(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            taut.Batch(taut.load(PUSH))
            taut.Batch(taut.load(PUSH).robot)
        self.assertEqual(len(caught), 1)
        self.assertIn("controllers, pushes", str(caught[0].message))
        self.assertIn("use Simulation", str(caught[0].message))

    def test_a_batch_warns_of_the_parts_that_an_experiment_still_has(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            taut.Batch(push(1).without_controllers())
        self.assertEqual(len(caught), 1)
        self.assertIn("the experiment has pushes, which", str(caught[0].message))


class OwnControllers(unittest.TestCase):
    def test_sees_the_worlds_that_are_due(self):
        calls = []

        class Watch:
            period_s, phase_s = 0.01, 0.002

            def act(self, seen, commands):
                calls.append((seen.world.copy(), seen.tick.copy(), seen.time_s.copy(), commands.rest_length_m.shape))

        sim = taut.Simulation(PUSH, worlds=11, controllers=[Watch()])
        sim.run_until(0.012 + 1e-6)
        times = sorted({float(round(t, 9)) for _, _, time_s, _ in calls for t in time_s})
        self.assertEqual(times, [0.002, 0.012])
        self.assertEqual(sorted(int(w) for world, tick, _, _ in calls for w in world[tick == 0]), list(range(11)))
        self.assertEqual(calls[0][3][1], len(sim.cables))

    def test_errors_of_a_controller_end_the_call(self):
        class Fails:
            period_s = 0.01

            def act(self, seen, commands):
                if seen.time_s[0] > 0.05:
                    raise RuntimeError("no more string")

        class Nan:
            period_s = 0.01

            def act(self, seen, commands):
                commands.rest_length_m[:] = np.nan

        class Shape:
            period_s = 0.01

            def act(self, seen, commands):
                commands.rest_length_m = np.zeros(3)

        with self.assertRaisesRegex(RuntimeError, "no more string"):
            taut.Simulation(PUSH, controllers=[Fails()]).run_until(1)
        with self.assertRaisesRegex(RuntimeError, "no more string"):
            taut.run(push(1), controllers=[Fails()])
        with self.assertRaisesRegex(ValueError, "commands.rest_length_m: nan for cable 0"):
            taut.Simulation(PUSH, controllers=[Nan()])
        with self.assertRaises(ValueError):
            taut.Simulation(PUSH, controllers=[Shape()])
        for wrong in (object(), 3, type("NoPeriod", (), {"act": None})()):
            self.assertRaises(TypeError, taut.Simulation, PUSH, controllers=[wrong])
        self.assertRaises(ValueError, taut.Simulation, PUSH, controllers=[type("Zero", (), {"act": lambda *_: None, "period_s": 0})()])

    def test_an_exception_ends_the_call_at_its_step(self):
        class Fails:
            period_s = 0.01

            def __init__(self):
                self.ticks = 0

            def act(self, seen, commands):
                self.ticks += 1
                if self.ticks == 6:
                    raise RuntimeError("once")

        controller = Fails()
        sim = taut.Simulation(PUSH, controllers=[controller])
        self.assertRaisesRegex(RuntimeError, "once", sim.run_until, 1000)
        self.assertAlmostEqual(sim.time_s()[0], 0.051)
        sim.run_until(0.1)
        self.assertEqual(controller.ticks, 10)

    def test_controllers_of_another_robot_are_refused(self):
        big, small = taut.load(str(ROOT / "share/models/superball.yaml")), taut.load(PRISM)
        impedance = taut.control.impedance(big, tension_offset_n=5)
        self.assertEqual(str(taut.control.impedance(big, big.cables[0])),
                         str(taut.control.impedance(big, [big.cables[0]])))
        position = taut.control.position(big, {big.cables[0]: [(0, 0.5)]})
        gait = taut.load(GAIT).controllers[0]
        for one in (impedance, position, gait):
            with self.assertRaises(ValueError) as caught:
                taut.Simulation(small, controllers=[one])
            self.assertIn("controllers[0]", str(caught.exception))
            self.assertRaises(ValueError, taut.run, taut.load(str(ROOT / "share/experiments/hang.yaml")), controllers=[one])
        for wrong in (impedance, 3, {}):  # not in a list
            self.assertRaises(TypeError, taut.Simulation, PUSH, controllers=wrong)

    def test_a_failed_restore_changes_nothing(self):
        class Fails:
            period_s = 0.01

            def act(self, seen, commands):
                pass

            def save(self, world):
                return b"memory"

            def restore(self, world, saved):
                raise RuntimeError("not today")

        sim = taut.Simulation(PUSH, worlds=2, controllers=[Fails()])
        sim.run_until(0.05)
        saved = sim.save(0)
        sim.run_until(0.1)
        before = [sim.hash(w) for w in range(2)]
        self.assertRaisesRegex(RuntimeError, "not today", sim.restore, saved)
        self.assertEqual([sim.hash(w) for w in range(2)], before)
        self.assertTrue(np.allclose(sim.time_s(), 0.1))

    def test_wrong_types_and_numbers_are_named(self):
        sim = taut.Simulation(PUSH)

        class Negative:
            period_s = 0.01

            def act(self, seen, commands):
                commands.rest_length_m[:] = -1

        for wrong, words in ((lambda: sim.tension_n(1.5), "cable: 1.5; expected a name or an index"),
                             (lambda: sim.tension_n(True), "cable: True"), (lambda: sim.set_gains(0), "no gain is given"),
                             (lambda: sim.set_gains(0, tension_offset_n="a"), "tension_offset_n: 'a'"),
                             (lambda: taut.Simulation(5), "experiment: 5")):
            with self.assertRaises(TypeError) as caught:
                wrong()
            self.assertIn(words, str(caught.exception))
        self.assertEqual(sim.tension_n(np.int64(1)).shape, (1,))
        for wrong, words in ((lambda: taut.Simulation(PUSH, worlds=5, variants=[{}]), "worlds: 5, but there are 1 variants"),
                             (lambda: taut.Simulation(PUSH, controllers=[Negative()]), "commands.rest_length_m: -1"),
                             (lambda: taut.control.impedance(taut.load(PRISM), period_s=1e-12), "period_s")):
            with self.assertRaises(ValueError) as caught:
                wrong()
            self.assertIn(words, str(caught.exception))

    def test_memory_is_saved_with_the_world(self):
        class Counts:
            period_s = 0.01

            def __init__(self):
                self.ticks = {}

            def act(self, seen, commands):
                for row, world in enumerate(seen.world):
                    self.ticks[int(world)] = self.ticks.get(int(world), 0) + 1
                    commands.rest_length_m[row] += 1e-4 * (self.ticks[int(world)] % 3)

            def save(self, world):
                return bytes([self.ticks[world]])

            def restore(self, world, saved):
                self.ticks[world] = saved[0]

        class Forgets:
            period_s = 0.01

            def act(self, seen, commands):
                pass

        bare = push(1).without_controllers()
        sim = taut.Simulation(bare, worlds=2, controllers=[Counts()])
        sim.run_until(0.055)
        saved = sim.save(0)
        sim.run_until(0.1)
        expected = sim.hash(0)
        sim.run_until(0.13)
        sim.restore(saved, 1)
        sim.run_until(0.1)
        self.assertEqual(sim.hash(1), expected)
        with self.assertRaisesRegex(TypeError, "Forgets: its state cannot be saved; define save"):
            taut.Simulation(bare, controllers=[Forgets()]).save()

    def test_reading_within_act_is_allowed_and_stepping_is_not(self):
        sims = []

        class Reads:
            period_s = 0.01

            def act(self, seen, commands):
                if sims:
                    assert sims[0].tension_n().shape[0] == 1 and sims[0].row().size > 0
                    sims[0].step()

        sims.append(taut.Simulation(PUSH, controllers=[Reads()]))
        with self.assertRaisesRegex(RuntimeError, "from within a step"):
            sims[0].run_until(0.1)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
