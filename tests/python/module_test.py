"""The Python module compared with the command; errors of wrong calls

module_test.py TAUT [unittest's arguments]
"""

import ast
import json
import math
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

import numpy as np

import taut

ROOT = pathlib.Path(__file__).resolve().parents[2]
PUSH = str(ROOT / "share/experiments" / "push_20n.yaml")
HANG = str(ROOT / "share/experiments" / "hang.yaml")
PRISM = str(ROOT / "share/models" / "prism3.yaml")
COMMAND = None


def short(seconds=0.3):
    experiment = taut.load(PUSH)
    experiment.duration_s = seconds
    return experiment


class OtherNumpys(unittest.TestCase):
    def test_numpy_2_is_refused_by_a_module_that_reads_the_layout_of_numpy_1(self):
        # Its arrays would have wrong values.
        ran = subprocess.run([sys.executable, "-c", "import numpy; numpy.__version__ = '2.0.0'; import taut"],
                             capture_output=True, text=True)
        if taut._core.supports_numpy_2:
            self.assertEqual(ran.returncode, 0, ran.stderr)
        else:
            self.assertRegex(ran.stderr, "ImportError: this build of taut needs NumPy 1, .* this is NumPy 2.0.0")


class Loading(unittest.TestCase):
    def test_a_model_and_an_experiment(self):
        robot, experiment = taut.load(PRISM), taut.load(PUSH)
        self.assertIsInstance(robot, taut.Robot)
        self.assertEqual(len(robot.bodies), 3)
        self.assertIsInstance(experiment, taut.Experiment)
        self.assertEqual(experiment.step_s, 0.001)
        self.assertEqual(len(experiment.robot.cables), 12)

    def test_parameters_are_numbers_or_expressions(self):
        stiff = taut.load(PUSH, stiffness_n_per_m=300).robot.parameters["stiffness_n_per_m"]
        same = taut.load(PUSH, stiffness_n_per_m="3 * 100").robot.parameters["stiffness_n_per_m"]
        self.assertEqual((stiff, same), (300, 300))

    def test_all_mistakes_are_told_at_once_with_their_places(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "bad.yaml"
            path.write_text("taut: 1\nkind: experiment\nname: bad\nmodel: nowhere.yaml\nsteps_s: 1\nduration_s: -1\n")
            with self.assertRaises(taut.InputError) as caught:
                taut.load(str(path))
        items = caught.exception.items
        self.assertTrue(all(item.file.endswith("bad.yaml") for item in items))
        self.assertGreaterEqual({item.line for item in items}, {5, 6})
        self.assertIn("step_s", "".join(item.hint for item in items))
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((str(again), again.items), (str(caught.exception), items))

    def test_other_kinds_of_files_are_refused(self):
        with self.assertRaisesRegex(taut.InputError, "models and experiments"):
            taut.load(str(ROOT / "share/gaits" / next(iter(sorted(os.listdir(ROOT / "share/gaits"))))))

    def test_what_it_says_in_numbers_is_the_same_experiment(self):
        experiment = short()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "resolved.yaml"
            path.write_text(experiment.to_yaml())
            again = taut.load(str(path))
        self.assertEqual(taut.run(again).state_hash, taut.run(experiment).state_hash)


class Running(unittest.TestCase):
    def test_gives_the_bits_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([COMMAND, "run", PUSH, "--duration_s", "0.3", "--quiet", "--out", folder + "/run"], check=True)
            summary = json.loads(pathlib.Path(folder, "run", "summary.json").read_text())
            recorded = taut.read_trace(folder + "/run/trace.h5")
            self.assertEqual(taut.read_trace(folder + "/run").metadata, recorded.metadata)
        ran = taut.run(short())
        self.assertEqual(f"{ran.state_hash:016x}", summary["state_hash"])
        self.assertEqual(ran.trace.channels, recorded.channels)
        for name in recorded.channels:
            np.testing.assert_array_equal(ran.trace[name], recorded[name], name)
        self.assertEqual(ran.trace.units["cable/outer_top_1/tension_n"], "N")
        self.assertEqual(ran.trace.metadata["seed"], "0")

    def test_a_mass_swings_with_its_period(self):
        experiment = taut.load(HANG, hang_m=1.02)
        experiment.duration_s = 0.5
        ran = taut.run(experiment)
        above = ran.trace["cable/cable/length_m"] - ran.trace["cable/cable/length_m"].mean()
        rising = np.flatnonzero((above[:-1] < 0) & (above[1:] >= 0))
        crossings = ran.trace.time_s[rising] + 0.005 * above[rising] / (above[rising] - above[rising + 1])
        self.assertAlmostEqual(np.diff(crossings).mean(), 2 * math.pi * math.sqrt(0.5 / 400), delta=2e-4)

    def test_rows_cannot_be_written_and_outlive_their_run(self):
        row = taut.run(short()).trace["cable/outer_top_1/tension_n"]
        self.assertTrue(np.isfinite(row).all())
        with self.assertRaises(ValueError):
            row[0] = 1

    def test_a_channel_that_is_not_there_is_named_with_the_closest(self):
        trace = taut.run(short(0.01)).trace
        with self.assertRaisesRegex(KeyError, "did you mean .*tension_n"):
            trace["cable/outer_top_1/tensoin_n"]

    def test_progress_may_stop_it(self):
        class Enough(Exception):
            pass

        def progress(time_s, duration_s):
            raise Enough

        experiment = taut.load(PUSH)
        experiment.duration_s = 1e6
        with self.assertRaises(Enough):
            taut.run(experiment, progress=progress)

    def test_control_c_stops_it(self):
        experiment = taut.load(PUSH)
        experiment.duration_s = 1e6
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            taut.run(experiment)


class Tables(unittest.TestCase):
    def test_pandas(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("no pandas")
        trace = taut.run(short(0.1)).trace
        frame = trace.to_pandas()
        self.assertEqual(list(frame.columns), trace.channels)
        np.testing.assert_array_equal(frame["cable/outer_top_1/tension_n"], trace["cable/outer_top_1/tension_n"])
        self.assertEqual(frame.attrs["seed"], "0")

    def test_xarray(self):
        try:
            import xarray  # noqa: F401
        except ImportError:
            self.skipTest("no xarray")
        trace = taut.run(short(0.1)).trace
        data = trace.to_xarray()
        self.assertEqual(data["cable_tension_n"].attrs["units"], "N")
        np.testing.assert_array_equal(data["cable_tension_n"].sel(cable="outer_top_1"),
                                      trace["cable/outer_top_1/tension_n"])
        self.assertEqual(sum(v.size for v in data.data_vars.values()), len(trace) * len(trace.channels))


class Batches(unittest.TestCase):
    def test_arrays_have_the_shapes_that_are_said(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=3)
        robot = taut.load(PUSH).robot
        b, c, n = len(robot.bodies), len(robot.cables), len(robot.nodes)
        self.assertEqual(batch.body_position_m().shape, (3, b, 3))
        self.assertEqual(batch.body_orientation().shape, (3, b, 4))
        for read in (batch.cable_length_m, batch.cable_rate_m_per_s, batch.rest_length_m, batch.tension_n,
                     batch.elastic_n, batch.rest_length_target_m):
            self.assertEqual(read().shape, (3, c))
        self.assertEqual(batch.node_position_m().shape, (3, n, 3))
        self.assertEqual(batch.node_velocity_m_per_s().shape, (3, n, 3))
        np.testing.assert_allclose(batch.body_orientation()[0, 0], [1, 0, 0, 0], atol=1e-15)

    def test_a_body_in_the_air_falls_as_it_should(self):
        batch = taut.Batch(taut.load(PRISM), worlds=2)
        before, steps, step_s = batch.body_position_m(), 100, 1e-3
        batch.step(step_s, steps)
        fallen = (before - batch.body_position_m()).mean(axis=1)  # three rods of equal mass
        np.testing.assert_allclose(fallen[:, 2], 0.5 * 9.81 * (steps * step_s) ** 2, rtol=0.02)
        np.testing.assert_allclose(batch.time_s(), 0.1, rtol=1e-12)

    def test_worlds_lanes_and_threads_give_the_same_bits(self):
        def hashes(**how):
            batch = taut.Batch(taut.load(PUSH).robot, **how)
            target = np.tile(batch.rest_length_target_m()[0], (batch.worlds, 1))
            target -= 0.001 * np.arange(batch.worlds)[:, None]
            batch.step(1e-3, 20, target)
            return [batch.hash(w) for w in range(batch.worlds)]

        many = hashes(worlds=11, threads=2)
        self.assertEqual(len(set(many)), 11)
        self.assertEqual(hashes(worlds=11, simd="scalar"), many)

    def test_targets_of_all_or_of_one_world(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=2)
        lengths = batch.rest_length_target_m()
        batch.set_rest_length_target(lengths[1] * 0.9, world=-1)
        np.testing.assert_array_equal(batch.rest_length_target_m(), [lengths[0], lengths[1] * 0.9])
        batch.set_rest_length_target(lengths * 0.8)
        np.testing.assert_array_equal(batch.rest_length_target_m(), lengths * 0.8)

    def test_parameters_of_each_world(self):
        batch = taut.Batch(taut.load(PRISM), worlds=3)
        batch.set_parameter("gravity_z_m_per_s2", [0, -1, -2])
        np.testing.assert_array_equal(batch.parameter("gravity_z_m_per_s2"), [0, -1, -2])
        stiffness = batch.parameter("cable_stiffness_n_per_m", -1)
        batch.set_parameter("cable_stiffness_n_per_m", stiffness * [1, 2, 3], -1)
        np.testing.assert_array_equal(batch.parameter("cable_stiffness_n_per_m", -1), stiffness * [1, 2, 3])
        np.testing.assert_array_equal(batch.parameter("cable_stiffness_n_per_m", 0), stiffness)
        before = batch.body_position_m()
        batch.step(1e-3, 100)
        fallen = (before - batch.body_position_m())[:, :, 2].mean(axis=1)
        np.testing.assert_allclose(fallen, [0, 0.005, 0.01], rtol=0.02, atol=1e-9)

    def test_snapshots(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=2)
        batch.step(1e-3, 5)
        kept, hash_then = batch.save(1), batch.hash(1)
        batch.step(1e-3, 5)
        self.assertNotEqual(batch.hash(1), hash_then)
        batch.restore(kept, 1)
        self.assertEqual(batch.hash(1), hash_then)
        batch.step(1e-3, 5)
        batch.restore(kept, None)
        self.assertEqual([batch.hash(0), batch.hash(1)], [hash_then] * 2)
        with self.assertRaisesRegex(ValueError, "of this model"):
            batch.restore(b"nothing")
        with self.assertRaisesRegex(ValueError, "of this model"):
            taut.Batch(taut.load(PRISM)).restore(kept)

    def test_contacts_carry_the_weight(self):
        batch = taut.Batch(taut.load(PUSH).robot)
        batch.step(1e-3, 3000)
        touching = batch.contacts()
        self.assertGreater(len(touching["gap_m"]), 2)
        self.assertTrue((touching["bodies"][:, 1] == -1).all())
        said = subprocess.run([COMMAND, "check", PUSH, "--json"], check=True, capture_output=True, text=True).stdout
        weight = 9.81 * json.loads(said)["total_mass_kg"]
        self.assertAlmostEqual(touching["force_n"][:, 2].sum(), weight, delta=0.02 * weight)

    def test_out_is_written_into(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=2)
        out = np.empty((2, 12))
        self.assertIs(batch.tension_n(out=out), out)
        np.testing.assert_array_equal(out, batch.tension_n())
        frozen = np.empty((2, 12))
        frozen.setflags(write=False)
        for bad, why in ((np.empty((2, 11)), "shape"), (np.empty((2, 12), np.float32), "float32"),
                         (np.empty((12, 2)).T, "contiguous"), (frozen, "writeable"), ([0], "not an array")):
            with self.assertRaisesRegex(ValueError, why):
                batch.tension_n(out=bad)

    def test_every_index_and_shape_is_looked_at(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=2)
        for call in (lambda: batch.hash(2), lambda: batch.hash(-3), lambda: batch.save(10**12),
                     lambda: batch.contacts(2), lambda: batch.set_node_force(0, 10**6, [0, 0, 0]),
                     lambda: batch.set_parameter("body_mass_kg", [1, 1], 99),
                     lambda: batch.parameter("friction_scale", 1), lambda: batch.parameter("cable_damping_n_s_per_m", 12),
                     lambda: batch.parameter("body_mass_kg", -4),
                     lambda: batch.set_rest_length_target(np.zeros(12), world=2)):
            self.assertRaises(IndexError, call)
        for call, why in ((lambda: batch.step(0), "step_s: 0; expected a number from 1e-09 to 1"),
                          (lambda: batch.step(math.nan), "step_s: nan; expected a number"),
                          (lambda: batch.step(1e-3, -1), "0 or more"),
                          (lambda: batch.step(1e-3, 1, np.zeros((2, 11))), r"\(2, 11\).*\(2, 12\)"),
                          (lambda: batch.set_rest_length_target(np.zeros(12)), r"\(12,\).*\(2, 12\)"),
                          (lambda: batch.set_rest_length_target("no"), "rest_length_m"),
                          (lambda: batch.set_parameter("mass", [1, 1]), "body_mass_kg"),
                          (lambda: batch.parameter("mass"), "body_mass_kg"),
                          (lambda: taut.Batch(taut.load(PUSH).robot, worlds=0), "expected 1 to 1000000000"),
                          (lambda: taut.Batch(taut.load(PUSH).robot, simd="wide"), "avx512")):
            self.assertRaisesRegex(ValueError, why, call)

    def test_threads_of_python_wait_for_each_other(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=4)
        threads = [threading.Thread(target=batch.step, args=(1e-3, 50)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        alone = taut.Batch(taut.load(PUSH).robot, worlds=4)
        alone.step(1e-3, 200)
        self.assertEqual([batch.hash(w) for w in range(4)], [alone.hash(w) for w in range(4)])

    def test_a_forked_child_is_told_and_does_not_hang(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=16, threads=2)
        batch.step(1e-3)
        child = os.fork()
        if child == 0:
            try:
                batch.step(1e-3)
            except RuntimeError as error:
                os._exit(0 if "fork" in str(error) else 1)
            os._exit(2)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)


class Types(unittest.TestCase):
    def test_stubs_name_what_there_is(self):
        tree = ast.parse(pathlib.Path(taut.__file__).with_name("_core.pyi").read_text())

        def named(body):
            names = {node.name: node for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
            return names | {node.target.id: node for node in body if isinstance(node, ast.AnnAssign)}

        def public(thing):
            return {name for name in vars(thing) if not name.startswith("_")}

        stubs = named(tree.body)
        self.assertEqual(set(stubs), public(taut._core))
        for name, node in stubs.items():
            if isinstance(node, ast.ClassDef):
                has = {n for n in named(node.body) if not n.startswith("_")}
                self.assertEqual(has, public(getattr(taut._core, name)), name)


if __name__ == "__main__":
    COMMAND = sys.argv.pop(1)
    warnings.simplefilter("error")
    unittest.main()
