"""Values without a meaning: the Python module raises an exception that names them and changes nothing.

values_test.py TAUT [unittest's arguments]
"""

import unittest

import numpy as np

import taut
import taut.gym
from helpers import PUSH, ROOT, main

SPINE = str(ROOT / "share/experiments" / "learn_spine.yaml")


class Values(unittest.TestCase):
    def test_parameters_have_the_limits_of_model_files(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=3)
        nan, infinite = float("nan"), float("inf")
        for name, wrong in (("body_mass_kg", (-1, 0, nan, infinite)), ("cable_stiffness_n_per_m", (-1000, 0, nan)),
                            ("cable_damping_n_s_per_m", (-1000, nan)), ("friction_scale", (-0.1, nan, infinite)),
                            ("gravity_z_m_per_s2", (nan, -infinite))):
            good, before = batch.parameter(name), batch.hash(1)
            for value in wrong:
                with self.assertRaisesRegex(ValueError, rf"values\[1\]: {name} must be .*, got "):
                    batch.set_parameter(name, [2 * good[0], value, good[2]])
            self.assertEqual(batch.hash(1), before)
            np.testing.assert_array_equal(batch.parameter(name), good)  # no world was changed

    def test_commands_are_finite(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=2)
        wrong = batch.rest_length_target_m()
        wrong[1, 3] = np.nan
        for call in (lambda: batch.set_rest_length_target(wrong), lambda: batch.step(1e-3, 1, wrong),
                     lambda: batch.rollout(wrong[:, None], 1e-3)):
            with self.assertRaisesRegex(ValueError, r"rest_length_\w+: nan at \(1, (0, )?3\); expected finite"):
                call()
        with self.assertRaisesRegex(ValueError, r"force_n: inf at \(2,\)"):
            batch.set_node_force(0, 0, [0, 0, float("inf")])

    def test_arrays_have_real_numbers(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=3)
        envs = taut.gym.make_vec(SPINE, 3)
        envs.reset(seed=1)
        linear = taut.linear_system(taut.load(str(ROOT / "share/experiments/hang.yaml")))
        masked = np.ma.masked_all(3)
        for wrong, named in ((np.ones(3) + 1j, "complex128"), (np.ones(3, "M8[s]"), r"datetime64\[s\]"), (["1"] * 3, "<U1"),
                             (np.zeros(3, [("a", "f8")]), "'a'"), (masked, "masked entries"), ([[1], 2, 3], "numbers")):
            for call in (lambda: batch.set_node_force(0, 0, wrong), lambda: batch.set_parameter("body_mass_kg", wrong),
                         lambda: linear.response(linear.inputs[0], linear.outputs[0], wrong)):
                with self.assertRaisesRegex(ValueError, named, msg=repr(wrong)):
                    call()
            if named != "numbers":
                actions = np.ma.masked_all(envs.action_space.shape) if wrong is masked else np.resize(
                    wrong, envs.action_space.shape)
                with self.assertRaisesRegex(ValueError, f"actions: .*{named}"):
                    envs.step(actions)
        for good in ([1, 2, 3], np.ones(3, "f4"), np.ones(6, ">i8")[::2], np.array([1.5] * 3, object), np.ma.ones(3)):
            batch.set_node_force(0, 0, good)
            envs.step(np.resize(good, envs.action_space.shape) * 0)

    def test_seeds_are_whole_numbers_from_0_on(self):
        env = taut.gym.make_vec(SPINE, 4)
        before = [env.hash(w) for w in range(4)]
        for seed in (-1, 1.5, float("nan"), 2**64, 2**64 - 1, "1", True, [-1, 2, 3, 4], [1.5, 2, 3, 4], [0, 0, 0, 2**64],
                     [True] * 4, np.array([-1, 2, 3, 4]), np.array([1.0, 2, 3, 4.5]), [None] * 4):
            with self.assertRaisesRegex(ValueError, "seed.*whole number", msg=repr(seed)):
                env.reset(seed=seed)
            with self.assertRaisesRegex(ValueError, "seed.*whole number", msg=repr(seed)):
                taut.gym.make_vec(SPINE, 4, seed=seed)
        self.assertEqual([env.hash(w) for w in range(4)], before)
        for seed in (0, np.int32(5), np.uint64(2**64 - 4), [2**64 - 1, 2, 3, 4], np.arange(4), (1, 2, 3, 4)):
            env.reset(seed=seed)
        single = taut.gym.Env(SPINE)
        for seed in (-1, 1.5):
            with self.assertRaises(Exception):
                single.reset(seed=seed)

    def test_experiments_have_numbers_that_mean_something(self):
        experiment = taut.load(PUSH)
        for wrong in (float("nan"), -1, 0, float("inf")):
            with self.assertRaisesRegex(ValueError, "duration_s: .*; expected a positive number"):
                experiment.duration_s = wrong
        for wrong in (-1, 1.5, 2**64):
            with self.assertRaisesRegex((ValueError, TypeError), "seed"):
                experiment.seed = wrong

    def test_functions_are_callable(self):
        experiment = taut.load(PUSH)
        for wrong in (5, "print", [], object()):
            named = r"progress: .*; expected a function"
            with self.assertRaisesRegex(TypeError, named):
                taut.run(experiment, progress=wrong)
            with self.assertRaisesRegex(TypeError, named):
                taut.rollout(experiment, "distance", 1, progress=wrong)
            with self.assertRaisesRegex(TypeError, named):
                taut.learn("no_such_study", progress=wrong)
            with self.assertRaisesRegex(TypeError, named):
                taut.fit("no_such_fit", progress=wrong)
            with self.assertRaisesRegex(TypeError, "observe: .*; expected a function"):
                taut.gym.make_vec(SPINE, observe=wrong)
            with self.assertRaisesRegex(TypeError, "judge: .*; expected a function"):
                taut.gym.make_vec(SPINE, judge=wrong)

    def test_methods_of_controllers_and_plants_are_callable(self):
        experiment = taut.load(PUSH)

        class Controller:
            period_s, act, save, restore = 0.01, print, print, print

        for name, wrong in (("act", 5), ("save", "no"), ("restore", 1.0), ("stateless", "no"), ("stateless", 1)):
            controller = Controller()
            setattr(controller, name, wrong)
            with self.assertRaisesRegex(TypeError, r"controllers\[0\]"):
                taut.Simulation(experiment, controllers=[controller])

        class Plant:
            observe, advance = 5, print

        with self.assertRaisesRegex(TypeError, "plant: .*; expected an object with observe"):
            taut.run(experiment, plant=Plant())

    def test_flags_are_bools(self):
        experiment = taut.load(PUSH)
        for wrong in ("no", 1, 0.5, None, []):
            expected = "; expected True or False"
            with self.assertRaisesRegex(TypeError, "skip_damaged: .*" + expected):
                taut.learn("no_such_study", skip_damaged=wrong)
            with self.assertRaisesRegex(TypeError, "skip_damaged: .*" + expected):
                taut.read_study("no_such_folder", skip_damaged=wrong)
            with self.assertRaisesRegex(TypeError, "design: .*" + expected):
                taut.fit("no_such_fit", design=wrong)
            with self.assertRaisesRegex(TypeError, "differences: .*" + expected):
                taut.linear_system(experiment, differences=wrong)
            with self.assertRaisesRegex(TypeError, "differenced_rate: .*" + expected):
                taut.control.impedance(experiment.robot, differenced_rate=wrong)
            for name in ("randomise", "copy"):
                with self.assertRaisesRegex(TypeError, f"{name}: .*" + expected):
                    taut.gym.make_vec(SPINE, **{name: wrong})
        for good in (True, np.True_, np.False_):
            taut.gym.make_vec(SPINE, randomise=good, copy=good)
        envs = taut.gym.make_vec(SPINE, 2)
        for wrong in ("no", [0.5, 1], [2, 0], np.zeros(3, bool), 1):
            with self.assertRaisesRegex((TypeError, ValueError), "reset_mask"):
                envs.reset(options={"reset_mask": wrong})
        envs.reset(options={"reset_mask": [True, False]})

    def test_texts_are_texts(self):
        experiment = taut.load(PUSH)
        for call in (lambda wrong: taut.load(wrong), lambda wrong: taut.read_trace(wrong),
                     lambda wrong: taut.learn(wrong), lambda wrong: taut.read_study(wrong), lambda wrong: taut.fit(wrong),
                     lambda wrong: taut.gym.make_vec(wrong), lambda wrong: taut.Simulation(wrong),
                     lambda wrong: taut.control.impedance(experiment.robot, [wrong]),
                     lambda wrong: taut.control.position(experiment.robot, {wrong: [(0, 1)]}),
                     lambda wrong: taut.rollout(experiment, wrong, 1),
                     lambda wrong: taut.fit("no_such_fit", profiles=[wrong]),
                     lambda wrong: taut.Batch(experiment.robot, simd=wrong), lambda wrong: taut.load(PUSH, push_n=wrong)):
            for wrong in (5.5j, object(), (1, 2)):
                with self.assertRaises(TypeError, msg=repr(wrong)):
                    call(wrong)
        with self.assertRaisesRegex(TypeError, "push_n: .*; expected a number or a text"):
            taut.load(PUSH, push_n=[1])
        with self.assertRaisesRegex(TypeError, "push_n: True; expected a number or a text"):
            taut.load(PUSH, push_n=True)

    def test_steps_and_times_have_limits(self):
        experiment = taut.load(PUSH)
        batch, sim = taut.Batch(experiment.robot), taut.Simulation(experiment)
        before, before_too = batch.hash(), sim.hash()
        for wrong in (1e308, 1.001, 1e-10, 0, -1e-3, float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, r"step_s: .*; expected a number from 1e-09 to 1 \[s\]"):
                batch.step(wrong)
            with self.assertRaisesRegex(ValueError, r"step_s: .*; expected a number from 1e-09 to 1 \[s\]"):
                batch.rollout(batch.rest_length_target_m()[:, None], wrong)
        for wrong in (2**63, 1e300, 1.1e9, float("nan"), float("inf"), -float("inf")):
            with self.assertRaisesRegex(ValueError, r"time_s: .*; expected a finite number up to 1e\+09 \[s\]"):
                sim.run_until(wrong)
            with self.assertRaisesRegex(ValueError, r"duration_s: .*; expected a positive number up to 1e\+09 \[s\]"):
                experiment.duration_s = wrong
        for wrong in (-1, 1.5, 2**31, 2**63):
            with self.assertRaises((TypeError, ValueError)):
                batch.step(1e-3, wrong)
            with self.assertRaises((TypeError, ValueError)):
                sim.step(wrong)
        self.assertEqual((batch.hash(), sim.hash()), (before, before_too))
        batch.step(1e-9)
        batch.step(1.0, 0)
        sim.run_until(-5)


if __name__ == "__main__":
    main()
