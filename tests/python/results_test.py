"""Studies, fits, analyses and linear systems from Python: against the command, closed forms, and wrong calls

results_test.py TAUT [unittest's arguments]
"""

import csv
import json
import math
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import taut
from helpers import COMMAND, FREQUENCY, GAIT, MASS, PRISM, PUSH, interrupted, main

STUDY = f"""taut: 1
kind: study
name: small
experiment: experiment.yaml
seed: 5
parameters: {{fastest_hz: 4}}
vary:
  - {{name: frequency, each: {FREQUENCY}, low: 0.5, high: fastest_hz, scale: log}}
  - {{each: motion.sine.*_1.phase_rad, low: -pi, high: pi}}
objective: {{measure: heading, direction: [0, 1, 0]}}
search:
  - {{method: monte_carlo, evaluations: 12, batch: 4}}
"""


class InAFolder(unittest.TestCase):
    def setUp(self):
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.folder = pathlib.Path(held.name)

    def path(self, name):
        return str(self.folder / name)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.path(name)

    def command(self, *words):
        return subprocess.run([COMMAND, *words], capture_output=True, text=True, cwd=self.folder)


class Studies(InAFolder):
    def setUp(self):
        super().setUp()
        self.write("experiment.yaml", f"taut: 1\nkind: experiment\nbase: {GAIT}\nduration_s: 0.4\n")
        self.study = self.write("study.yaml", STUDY)

    def test_finds_what_the_command_finds(self):
        found = taut.learn(self.study, self.path("python"))
        self.assertEqual(self.command("learn", "study.yaml", "--out", "command", "--quiet").returncode, 0)
        same = taut.read_study(self.path("command"))
        np.testing.assert_array_equal(found.values, same.values)
        np.testing.assert_array_equal(found.scores, same.scores)
        self.assertEqual((len(found), found.values.shape), (12, (12, len(found.parameters))))
        self.assertEqual(found.parameters[0], "frequency." + FREQUENCY)
        self.assertEqual(found.units[found.parameters[0]], "Hz")
        at = int(np.nanargmax(found.scores))
        self.assertEqual(found.best_score, found.scores[at])
        self.assertEqual(list(found.best.values()), list(found.values[at]))
        self.assertEqual(found.failed, [""] * 12)

    def test_the_experiment_of_an_evaluation_has_its_score(self):
        found = taut.learn(self.study, self.path("a"), threads=1)
        for evaluation in (None, 3):
            experiment = found.experiment(evaluation)
            row = taut.rollout(experiment, {"measure": "heading", "direction": [0, 1, 0]}, 1)
            score = found.best_score if evaluation is None else found.scores[evaluation]
            self.assertEqual(row["score"][0], score)
            self.assertEqual(row["state_hash"][0], taut.run(experiment).state_hash)
        self.assertRaises(IndexError, lambda: found.experiment(12))

    def test_pandas(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("no pandas")
        found = taut.learn(self.study, self.path("a"))
        frame = found.to_pandas()
        self.assertEqual(list(frame.columns), [*found.parameters, "score", "failed"])
        np.testing.assert_array_equal(frame[found.parameters].to_numpy(), found.values)
        self.assertEqual(frame.attrs["units"], found.units)

    def test_control_c_keeps_what_was_found_and_the_same_call_goes_on(self):
        long = self.write("long.yaml", STUDY.replace("evaluations: 12", "evaluations: 100000"))
        interrupted(self, lambda: taut.learn(long, self.path("a")))
        kept = taut.read_study(self.path("a"))
        self.assertGreater(len(kept), 0)
        more = self.write("long.yaml", STUDY.replace("evaluations: 12", f"evaluations: {len(kept) + 8}"))
        done = taut.learn(more, self.path("a"))
        whole = taut.learn(more, self.path("b"))
        self.assertEqual(len(done), len(kept) + 8)
        np.testing.assert_array_equal(done.scores, whole.scores)
        np.testing.assert_array_equal(done.scores[:len(kept)], kept.scores)

    def test_progress_says_where_it_stands(self):
        seen = []
        long = self.write("long.yaml", STUDY.replace("evaluations: 12", "evaluations: 100000"))

        def progress(*now):
            seen.append(now)
            raise StopIteration

        self.assertRaises(StopIteration, lambda: taut.learn(long, self.path("a"), progress=progress))
        evaluations, budget, best = seen[0]
        self.assertTrue(0 < evaluations < budget == 100000 and math.isfinite(best))

    def test_parameters_are_set_and_mistakes_told(self):
        slow = taut.learn(self.study, self.path("a"), fastest_hz=0.6)
        self.assertLessEqual(slow.values[:, 0].max(), 0.6)
        for call, why in ((lambda: taut.learn(self.study, self.path("a")), "another study|other"),
                          (lambda: taut.learn(self.study, fastest=1), 'no parameter "fastest"'),
                          (lambda: taut.learn(PUSH), "kind must be study, got experiment.*taut run"),
                          (lambda: taut.load(self.study), "kind must be .*got study.*taut learn"),
                          (lambda: taut.read_study(self.path("nowhere")), "nowhere")):
            self.assertRaisesRegex(taut.InputError, why, call)
        self.assertRaisesRegex(ValueError, "threads", lambda: taut.learn(self.study, threads=-1))


# A mass on a cable that is wound in hangs at 1 - (L + m g / k); the true value for the fit is k = 110 N/m.
HANGING = """taut: 1
kind: model
name: hanging
parameters: {k_n_per_m: 100, mass_kg: 0.5}
nodes: {top: [0, 0, 1], ball: [0, 0, 0]}
pairs: [{name: c, nodes: [top, ball], tags: [cable]}]
builders:
  - {match: top, anchor: {}}
  - {match: ball, point_mass: {mass_kg: mass_kg, radius_m: 0.01}}
  - {match: cable, cable: {stiffness_n_per_m: k_n_per_m, damping_n_s_per_m: 8, rest_length_m: 0.9, actuator: {ideal: true}}}
"""
PULL = """taut: 1
kind: experiment
name: pull
model: model.yaml
gravity_m_per_s2: [0, 0, -10]
duration_s: 20
controllers:
  - {name: play, period_s: 0.01, position: {programs: [{cables: c, change_m: [[0, 0], [1, -0.01], [2, -0.02], [3, -0.03], [4, -0.04], [5, -0.05]]}]}}
"""
FIT = """taut: 1
kind: fit
name: f
experiments:
  - {name: a, experiment: experiment.yaml, data: a.csv, forward: static}
  - {name: b, experiment: experiment.yaml, data: b.csv, forward: static, use: test}
estimate:
  - {parameter: k_n_per_m, prior: {sd: 20}}
residuals:
  - {channel: node/ball/position_z_m, sd: 0.001, window: {after_setpoint_s: [-0.1, 0.1]}}
groups: window
"""


class Fits(InAFolder):
    def setUp(self):
        super().setUp()
        self.write("model.yaml", HANGING)
        self.write("experiment.yaml", PULL)
        self.fit = self.write("fit.yaml", FIT)
        noise = np.random.default_rng(1).normal(0, 0.001, (2, 5))
        for name, of in zip(("a.csv", "b.csv"), noise):
            with open(self.path(name), "w", newline="") as file:
                rows = csv.writer(file)
                rows.writerow(["time_s", "node/ball/position_z_m"])
                rows.writerows([i, 1 - (0.9 - 0.01 * i + 0.5 * 10 / 110) + of[i - 1]] for i in range(1, 6))

    def test_finds_the_truth_and_what_the_command_finds(self):
        fitted = taut.fit(self.fit)
        k, se = fitted.values["k_n_per_m"], fitted.standard_errors["k_n_per_m"]
        self.assertLess(abs(k - 110), 4 * se)
        # sd of five means through dz/dk = m g / k^2, combined with the prior
        alone = 0.001 / math.sqrt(5) / (0.5 * 10 / k**2)
        self.assertAlmostEqual(math.sqrt(fitted.covariance[0, 0]), 1 / math.hypot(1 / alone, 1 / 20), delta=0.02 * alone)
        np.testing.assert_allclose(fitted.correlation, [[1]])
        self.assertTrue(fitted.good)
        self.assertEqual(fitted.data["judgement"], "good")
        self.assertEqual(fitted.data["parameters"][0]["verdict"], "estimated")
        self.assertEqual(fitted.data["sentences"], fitted.sentences)
        done = self.command("fit", "fit.yaml", "--out", "out", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads((self.folder / "out" / "summary.json").read_text()), fitted.data)
        self.assertFalse((self.folder / "runs").exists())

    def test_its_experiment_has_what_was_found(self):
        fitted = taut.fit(self.fit)
        self.assertEqual(fitted.experiment().robot.parameters["k_n_per_m"], fitted.values["k_n_per_m"])
        self.assertRaises(IndexError, lambda: fitted.experiment(2))

    def test_what_two_numbers_share_makes_their_errors_large(self):
        self.write("fit.yaml", FIT.replace("sd: 20}}", "sd: 20}}\n  - {parameter: mass_kg, prior: {sd: 0.05}}"))
        fitted = taut.fit(self.fit)
        for one in fitted.data["parameters"]:
            larger = max(one["se"], one["se_jackknife"] or 0)
            self.assertEqual(fitted.standard_errors[one["name"]], larger)
        first = fitted.data["parameters"][0]
        self.assertAlmostEqual(math.sqrt(fitted.covariance[0, 0]), first["se"], delta=1e-9)
        self.assertGreater(first["se"], 3 * 0.001 / (5 / 110**2))  # with a known mass its error would be much smaller
        self.assertGreater(fitted.correlation[0, 1], 0.9)

    def test_a_folder_keeps_what_was_computed(self):
        first = taut.fit(self.fit, self.path("out"))
        again = taut.fit(self.fit, self.path("out"))
        self.assertEqual(first.json, again.json)
        self.assertTrue((self.folder / "out" / "fit.sqlite").exists())

    def test_a_verdict_that_is_bad_is_data(self):
        self.write("model.yaml", HANGING.replace("mass_kg: 0.5}", "mass_kg: 0.8}"))
        fitted = taut.fit(self.write("fit.yaml", FIT.replace("sd: 20", "sd: 0.2")))
        self.assertFalse(fitted.good)
        self.assertEqual(fitted.data["judgement"], "rejected")

    def test_pandas(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("no pandas")
        fitted = taut.fit(self.fit)
        frame = fitted.to_pandas()
        self.assertEqual(list(frame["held_out"]), [False] * 5 + [True] * 5)
        left = 1 - (0.9 - 0.01 * frame["time_s"] + 5 / fitted.values["k_n_per_m"])
        np.testing.assert_allclose(frame["fitted"], left, atol=1e-6)

    def test_mistakes_are_told(self):
        self.assertRaisesRegex(taut.InputError, "k_n_per_m", lambda: taut.fit(self.fit, profiles=["k"]))
        self.assertRaisesRegex(taut.InputError, "kind must be fit", lambda: taut.fit(PUSH))
        self.write("a.csv", "time_s,other\n1,2\n")
        self.assertRaises(taut.InputError, lambda: taut.fit(self.fit))


class Analyses(unittest.TestCase):
    def test_a_mass_on_a_cable_hangs_by_its_weight(self):
        found = taut.analyze(taut.load(MASS, hang_m=1.1))
        self.assertTrue(found.found, found.why)
        self.assertEqual(found.load_case, "own_weight")
        np.testing.assert_allclose(found.tension_n, [0.5 * 9.81], rtol=1e-9)
        mass = 0  # the ceiling is fixed and no body
        np.testing.assert_allclose(found.body_position_m[mass], [0, 0, 2 - 1 - 0.5 * 9.81 / 400], atol=1e-9)
        # vertical sqrt(k / m), horizontal a pendulum
        up, sideways = math.sqrt(400 / 0.5), math.sqrt(9.81 / (1 + 0.5 * 9.81 / 400))
        swings = found.mode_frequency_hz[[kind == "elastic" for kind in found.mode_kinds]]
        np.testing.assert_allclose(swings, np.array([sideways, sideways, up]) / 2 / math.pi, rtol=1e-6)
        self.assertEqual(found.mode_translation_m.shape, (3, 1, 3))
        np.testing.assert_allclose(np.abs(found.mode_translation_m[-1, mass]), [0, 0, 1], atol=1e-9)
        at = 6 * found.moving_bodies.index(mass)
        self.assertAlmostEqual(found.stiffness[at + 2, at + 2], 400, delta=1e-6)
        self.assertAlmostEqual(found.stiffness[at, at], 0.5 * sideways**2, delta=1e-6)  # at equilibrium
        self.assertAlmostEqual(found.mass[at, at], 0.5, delta=1e-12)

    def test_a_prism_has_one_state_of_self_stress(self):
        robot = taut.load(PRISM)
        found = taut.analyze(robot)
        self.assertEqual(found.load_case, "unloaded")
        kinds = [kind for kind, _, _ in found.members]
        self.assertEqual([name for kind, name, _ in found.members if kind == "cable"], robot.cables)
        self.assertEqual(found.self_stress_n.shape, (1, len(kinds)))
        self.assertTrue(found.self_stress_feasible[0])
        np.testing.assert_allclose(found.equilibrium_matrix @ found.self_stress_n[0], 0, atol=1e-9)
        self.assertEqual(found.rank, len(kinds) - 1)
        self.assertEqual(found.rigid, 6)
        self.assertEqual(found.mechanism_translation_m.shape[1:], (3, 3))
        self.assertEqual(len(found.mechanism_stiffness_n_per_m), len(found.mechanism_translation_m))
        self.assertTrue((found.mechanism_stiffness_n_per_m > 0).all())
        densities = found.self_stress_density_n_per_m[0]
        lengths = taut.Batch(robot).cable_length_m()[0]
        np.testing.assert_allclose(densities[:len(lengths)] * lengths, found.self_stress_n[0, :len(lengths)], rtol=1e-9)

    def test_missing_supports_are_an_error(self):
        text = """
taut: 1
kind: model
name: pole
nodes: {foot: [0, 0, 0], top: [0, 0, %s]}
pairs: [{name: pole, nodes: [foot, top]}]
builders:
  - {match: pole, rod: {radius_m: 0.01, mass_kg: 1}}
  - {match: foot, support: {kind: ball}}
"""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "pole.yaml"
            path.write_text(text % "1")
            with self.assertRaisesRegex(taut.InputError, "rotate about x and y through .0, 0, 0., and the loads topple"):
                taut.analyze(taut.load(str(path)))
            path.write_text(text % "-1")  # hanging: m g l / 2 per displacement of its center, l / 2
            self.assertAlmostEqual(taut.analyze(taut.load(str(path))).least_stiffness_n_per_m, 2 * 9.81, delta=1e-9)

    def test_says_what_the_command_says(self):
        said = json.loads(subprocess.run([COMMAND, "analyze", PUSH, "--json", "--modes", "1000"], check=True,
                                         capture_output=True, text=True).stdout)
        found = taut.analyze(taut.load(PUSH))
        case, described = said["load_cases"][0], said["as_described"]
        self.assertEqual(list(found.tension_n), [one["tension_n"] for one in case["members"] if one["kind"] == "cable"])
        self.assertEqual(found.body_position_m.tolist(), [one["position_m"] for one in case["bodies"]])
        self.assertEqual(found.body_orientation.tolist(), [one["orientation"] for one in case["bodies"]])
        self.assertEqual(list(found.mode_frequency_hz), [one["frequency_hz"] for one in case["modes"]["modes"]])
        self.assertEqual(found.mode_kinds, [one["kind"] for one in case["modes"]["modes"]])
        for name in ("translation_m", "turn_rad"):
            self.assertEqual(getattr(found, "mode_" + name).tolist(),
                             [[body[name] for body in one["shape"]] for one in case["modes"]["modes"]])
        self.assertEqual(found.residual_n, case["residual_n"])
        self.assertEqual(found.least_stiffness_n_per_m, case["least_stiffness_n_per_m"])
        self.assertEqual(found.largest_move_m, case["largest_move"]["distance_m"])
        self.assertEqual(found.largest_move_of, case["largest_move"]["of"])
        self.assertEqual(found.left_out, case["left_out"])
        held = taut.load(PUSH).robot
        self.assertEqual(list(taut.analyze(held).tension_n), list(found.tension_n))
        self.assertGreater(len(described["members"]), 0)
        batch = taut.Batch(held)
        weight = 9.81 * sum(batch.parameter("body_mass_kg", body)[0] for body in range(len(held.bodies)))
        self.assertAlmostEqual(found.contacts["force_n"][:, 2].sum(), weight, delta=1e-6)

    def test_a_robot_is_where_it_stands(self):
        found = taut.analyze(taut.load(PUSH))
        there = taut.Batch(found.robot)
        np.testing.assert_allclose(there.body_position_m()[0], found.body_position_m, atol=1e-12)
        np.testing.assert_allclose(there.elastic_n()[0], found.tension_n, atol=1e-6)
        np.testing.assert_allclose(found.body_orientation[:, 0] ** 2 + (found.body_orientation[:, 1:] ** 2).sum(axis=1), 1)

    def test_load_cases_are_named(self):
        with self.assertRaisesRegex(taut.InputError, 'no load case "snow"'):
            taut.analyze(taut.load(PUSH), "snow")
        self.assertRaises(TypeError, lambda: taut.analyze("path"))


class LinearSystems(InAFolder):
    def test_a_mass_on_a_cable_swings_as_by_hand(self):
        system = taut.linear_system(taut.load(MASS, damping_n_s_per_m=4))
        n, u, y = len(system.states), len(system.inputs), len(system.outputs)
        self.assertEqual([m.shape for m in (system.A, system.B, system.C, system.D)], [(n, n), (n, u), (y, n), (y, u)])
        self.assertEqual(len(system.state_units), n)
        self.assertEqual(system.output_units[system.outputs.index("node/mass/position_z")], "m")
        self.assertAlmostEqual(system.output_at[system.outputs.index("node/mass/position_z")],
                               2 - 1 - 0.5 * 9.81 / 400, delta=1e-7)
        z = np.linalg.eigvals(system.A).astype(complex)
        swings = np.log(z[np.abs(z) > 0.5]) / system.period_s  # modes that decay within a tick or two do not oscillate
        fast = swings[np.argmax(swings.imag)]
        self.assertAlmostEqual(fast.imag, math.sqrt(400 / 0.5 - (4 / 0.5 / 2) ** 2), delta=0.02)
        self.assertAlmostEqual(fast.real, -4 / 0.5 / 2, delta=0.02)
        # far below resonance the displacement is 1 / k; far above 1 / (m w^2), with opposite phase
        gain, phase = system.response("node/mass/force_z", "node/mass/position_z", [0.01, 100])
        self.assertAlmostEqual(gain[0], 1 / 400, delta=1e-5)
        self.assertAlmostEqual(gain[1] * 0.5 * (200 * math.pi) ** 2, 1, delta=0.05)
        self.assertAlmostEqual(phase[0], 0, delta=1e-3)
        self.assertAlmostEqual(abs(phase[1]), math.pi, delta=0.5)  # plus about 0.63 rad of the tick's delay

    def test_is_what_the_command_writes(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("no h5py")
        system = taut.linear_system(taut.load(PRISM))
        done = self.command("analyze", PRISM, "--linear", "prism.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(self.path("prism.h5")) as file:
            for name in "ABCD":
                np.testing.assert_array_equal(file[name][:], getattr(system, name))

    def test_wrong_names_and_frequencies(self):
        system = taut.linear_system(taut.load(MASS))
        with self.assertRaisesRegex(KeyError, 'did you mean "node/mass/force_z"'):
            system.response("node/mass/forze_z", "node/mass/position_z", [1])
        for bad in ([-1], [1e9], [math.nan], 3, "no"):
            self.assertRaisesRegex(ValueError, "frequencies_hz",
                                   lambda: system.response("node/mass/force_z", "node/mass/position_z", bad))


class Data(unittest.TestCase):
    def test_files_that_come_along_are_found(self):
        self.assertEqual(pathlib.Path(taut.data_path("models", "prism3.yaml")).resolve(), pathlib.Path(PRISM))
        self.assertEqual(taut.data_path("experiments/push_20n.yaml"), str(pathlib.Path(taut.data_path()) /
                                                                         "experiments" / "push_20n.yaml"))
        with self.assertRaisesRegex(FileNotFoundError, "nothing.yaml"):
            taut.data_path("models", "nothing.yaml")


if __name__ == "__main__":
    main()
