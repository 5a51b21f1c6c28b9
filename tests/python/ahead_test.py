"""Rollouts, command sequences and zero-copy rows: compared with runs, steps and copies; wrong calls.

ahead_test.py TAUT [unittest's arguments]
"""

import gc
import math
import subprocess
import unittest

import numpy as np

import taut
from helpers import COMMAND, FREQUENCY, GAIT, PRISM, PUSH, ROOT, gait, interrupted, main

GOAL = str(ROOT / "share/experiments" / "roll_to_goal.yaml")


class Rollouts(unittest.TestCase):
    def test_a_world_goes_through_the_bits_of_its_run(self):
        experiment = gait()
        rows = taut.rollout(experiment, "distance", [{}, {"seed": 3}, {FREQUENCY: 2.0}, {"model.friction": 0.5}],
                            threads=2)
        self.assertEqual(rows["state_hash"][0], taut.run(experiment).state_hash)
        self.assertEqual(rows["state_hash"][0], rows["state_hash"][1])  # independent of the seed
        self.assertEqual(len(set(rows["state_hash"])), 3)
        self.assertTrue((rows["failed"] == "").all() and np.isfinite(rows["score"]).all())
        np.testing.assert_array_equal(rows["score"], rows["distance_m"])
        self.assertTrue(np.isnan(rows["fell_s"]).all())

    def test_scores_are_what_the_trace_says(self):
        experiment = gait(0.5)
        ran = taut.run(experiment)
        rows = taut.rollout(experiment, {"measure": "heading", "direction": np.array([0, 1, 0]), "from_s": 0.2,
                                         "tension_limit": {"limit_n": 1, "penalty_per_n": 0.25}}, 1)
        from_there = np.flatnonzero(np.isclose(ran.trace.time_s, 0.2))[0]
        along = ran.trace["system/com_y_m"][-1] - ran.trace["system/com_y_m"][from_there]
        most = max(ran.max_tension_n.values())
        self.assertAlmostEqual(rows["along_m"][0], along, delta=1e-12)
        self.assertAlmostEqual(rows["max_tension_n"][0], most, delta=1e-9)
        self.assertAlmostEqual(rows["score"][0], along - 0.25 * (most - 1), delta=1e-9)

    def test_a_number_of_worlds_have_seeds_one_after_the_other(self):
        experiment = taut.load(GOAL)  # its start depends on the seed
        experiment.duration_s, experiment.seed = 0.05, 4
        rows = taut.rollout(experiment, "nearer", 2)
        same = taut.rollout(experiment, "nearer", [{"seed": 4}, {"seed": np.int64(5)}])
        self.assertEqual(rows.tobytes(), same.tobytes())  # equal bytes, including NaN
        experiment.seed = 5
        ran = taut.run(experiment)
        self.assertEqual(rows["state_hash"][1], ran.state_hash)
        self.assertNotEqual(*rows["state_hash"])

    def test_company_threads_and_lanes_do_not_matter(self):
        worlds = [{FREQUENCY: 1 + 0.1 * i} for i in range(9)]
        experiment = gait(0.1)
        together = taut.rollout(experiment, "distance", worlds, threads=2)
        self.assertEqual(taut.rollout(experiment, "distance", worlds, simd="scalar").tobytes(), together.tobytes())
        self.assertEqual(taut.rollout(experiment, "distance", worlds[4:6]).tobytes(), together[4:6].tobytes())

    def test_a_world_that_fails_says_why(self):
        rows = taut.rollout(gait(), {"measure": "distance", "max_speed_m_per_s": 1e-6}, 2)
        self.assertTrue(np.isnan(rows["score"]).all())
        self.assertTrue(all("m/s" in why or "fast" in why for why in rows["failed"]), rows["failed"])

    def test_what_can_be_varied_is_listed_as_the_command_lists_it(self):
        said = subprocess.run([COMMAND, "learn", "--parameters", GAIT], check=True, capture_output=True, text=True)
        found = taut.tunables(taut.load(GAIT))
        self.assertEqual([line.split()[0] for line in said.stdout.splitlines()], list(found["name"]))
        self.assertTrue((found["least"] <= found["value"]).all() and (found["value"] <= found["greatest"]).all())

    def test_all_mistakes_are_told_at_once(self):
        with self.assertRaises(taut.InputError) as caught:
            taut.rollout(gait(), {"measure": "distanse", "form_s": 1, "from_s": 9},
                         [{"motion.sine.frequency": 1}, {FREQUENCY: -1}, {FREQUENCY: math.nan}])
        said = str(caught.exception)
        for what in ("distanse", "form_s", "must be before the end of the experiment",
                     'worlds[0]: there is no parameter "motion.sine.frequency"', "did you mean",
                     "worlds[1]: " + FREQUENCY, "worlds[2]"):
            self.assertIn(what, said)
        for objective, why in (({"measure": "nearer"}, "goal"), ({"measure": "distance", "from_s": 9}, "before"),
                               ({}, "measure"), ({"measure": "distance", "from_s": math.nan}, "from_s"),
                               ({"measure": "heading"}, "direction")):
            self.assertRaisesRegex(taut.InputError, why, lambda: taut.rollout(gait(), objective, 1))
        for worlds, why in (([3], r"worlds\[0\].*dict"), ([{"seed": -1}], "seed"), ([{"seed": 0.5}], "seed"),
                            ([{FREQUENCY: "2"}], "number"), (-1, "0 or more")):
            self.assertRaisesRegex(ValueError, why, lambda: taut.rollout(gait(), "distance", worlds))
        self.assertRaisesRegex(ValueError, "threads", lambda: taut.rollout(gait(), "distance", 1, threads=-1))
        self.assertRaises(TypeError, lambda: taut.rollout(gait(), {"measure": object()}, 1))
        self.assertEqual(len(taut.rollout(gait(), "distance", [])), 0)

    def test_control_c_and_progress_end_it(self):
        interrupted(self, lambda: taut.rollout(gait(1e6), "distance", 2))

        def progress(done, worlds):
            raise KeyError((done, worlds))

        short_ones = [{FREQUENCY: 1 + i / 1e4} for i in range(3000)]
        with self.assertRaises(KeyError) as caught:
            taut.rollout(gait(0.05), "distance", short_ones, progress=progress)
        self.assertEqual(caught.exception.args[0][1], len(short_ones))


class Sequences(unittest.TestCase):
    def targets(self, batch, ticks):
        noise = np.random.default_rng(0).uniform(-0.005, 0.005, (batch.worlds, ticks, 12))
        return batch.rest_length_target_m()[:, None] + noise

    def test_is_what_steps_one_by_one_give(self):
        whole, single = taut.Batch(taut.load(PUSH).robot, worlds=5, threads=2), taut.Batch(taut.load(PUSH).robot, worlds=5)
        whole.step(1e-3, 20)
        start = whole.save(2)
        targets = self.targets(whole, 4)
        positions = whole.rollout(targets, 1e-3, count=3, start=start)
        single.restore(start, None)
        for tick in range(4):
            single.step(1e-3, 3, targets[:, tick])
            np.testing.assert_array_equal(positions[:, tick], single.body_position_m())
        self.assertEqual([whole.hash(w) for w in range(5)], [single.hash(w) for w in range(5)])
        self.assertEqual(positions.shape, (5, 4, 3, 3))
        out = np.empty_like(positions)
        self.assertIs(whole.rollout(targets, 1e-3, 3, start, out), out)
        np.testing.assert_array_equal(out, positions)
        self.assertFalse((whole.rollout(targets, 1e-3, 3) == positions).any())  # continues from the current state

    def test_wrong_calls(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=2)
        good = self.targets(batch, 3)
        for call, why in ((lambda: batch.rollout(good[0], 1e-3), r"\(3, 12\).*\(2, 1, 12\)"),
                          (lambda: batch.rollout(good[:1], 1e-3), r"\(1, 3, 12\).*\(2, 3, 12\)"),
                          (lambda: batch.rollout("no", 1e-3), "expected float64"),
                          (lambda: batch.rollout(good, 0), "step_s: 0; expected a number from 1e-09 to 1"),
                          (lambda: batch.rollout(good, 1e-3, 0), "at least 1"),
                          (lambda: batch.rollout(good, 1e-3, 1, b"no"), "start"),
                          (lambda: batch.rollout(good, 1e-3, out=np.empty((2, 3, 3))), "out")):
            self.assertRaisesRegex(ValueError, why, call)
        self.assertRaises(TypeError, lambda: batch.rollout(good, 1e-3, 1, "text"))

    def test_control_c_ends_it(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=2)
        interrupted(self, lambda: batch.rollout(np.repeat(self.targets(batch, 1), 5000, axis=1), 1e-3, 1000))


class Rows(unittest.TestCase):
    def check(self, batch):
        """Compares every row with the copies returned by the batch's methods."""
        rows, worlds = batch.rows, np.arange(batch.worlds)
        group, lane = worlds // batch.lanes, worlds % batch.lanes
        for name in ("body_position_m", "body_velocity_m_per_s", "rest_length_m", "rest_length_target_m", "cable_length_m",
                     "cable_rate_m_per_s", "tension_n", "elastic_n"):
            view = getattr(rows, name)
            np.testing.assert_array_equal(view[group, :, lane].reshape(batch.worlds, -1),
                                          getattr(batch, name)().reshape(batch.worlds, -1), name)
            self.assertFalse(view.flags.owndata)
            self.assertEqual(view.flags.writeable, name == "rest_length_target_m")

    def test_they_are_what_the_methods_copy(self):
        for how in ({"worlds": 19}, {"worlds": 3, "simd": "scalar"}, {}):
            batch = taut.Batch(taut.load(PUSH).robot, **how)
            target = batch.rest_length_target_m()
            batch.step(1e-3, 30, target - 0.001 * np.arange(batch.worlds)[:, None])
            self.check(batch)

    def test_they_show_what_is_now(self):
        batch = taut.Batch(taut.load(PUSH).robot, worlds=4)
        position = batch.rows.body_position_m
        before = position.copy()
        batch.step(1e-3, 10)
        self.assertFalse((position == before).all())
        self.check(batch)

    def test_targets_that_are_written_are_commanded(self):
        written, told = (taut.Batch(taut.load(PUSH).robot, worlds=5) for _ in range(2))
        target = told.rest_length_target_m() - 0.01 * np.arange(1, 6)[:, None]
        rows, worlds = written.rows.rest_length_target_m, np.arange(5)
        rows[worlds // written.lanes, :, worlds % written.lanes] = target
        np.testing.assert_array_equal(written.rest_length_target_m(), target)
        written.step(1e-3, 20)
        told.step(1e-3, 20, target)
        self.assertEqual([written.hash(w) for w in worlds], [told.hash(w) for w in worlds])

    def test_others_cannot_be_written(self):
        rows = taut.Batch(taut.load(PUSH).robot, worlds=2).rows
        with self.assertRaises(ValueError):
            rows.body_position_m[0, 0, 0] = 1
        with self.assertRaises(ValueError):
            rows.tension_n.setflags(write=True)

    def test_they_keep_their_batch_alive(self):
        rows = taut.Batch(taut.load(PUSH).robot, worlds=200).rows.body_position_m
        kept = rows.copy()
        gc.collect()
        taut.Batch(taut.load(PRISM), worlds=200)  # would reuse freed memory
        np.testing.assert_array_equal(rows, kept)


if __name__ == "__main__":
    main()
