"""taut.gym: tests of Gymnasium's contract, bitwise equality with the command, Gymnasium's checker if it is installed"""

import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np

import taut
import taut.gym
from taut.gym import AutoresetMode, EpisodeEnd

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPINE = str(ROOT / "share/experiments" / "learn_spine.yaml")
ROLL = str(ROOT / "share/experiments" / "learn_roll.yaml")


def short(seconds=0.05):
    """Returns an experiment with episodes of five steps."""
    experiment = taut.load(SPINE)
    experiment.duration_s = seconds
    return experiment


def actions_of(envs, steps, seed=0):
    return np.random.default_rng(seed).uniform(-1, 1, (steps, *envs.action_space.shape)).astype(np.float32)


class Contract(unittest.TestCase):
    def test_spaces_and_arrays_are_what_is_said(self):
        envs = taut.gym.make_vec(SPINE, 5)
        self.assertEqual(envs.single_action_space.shape, (12,))
        self.assertEqual(envs.action_space.shape, (5, 12))
        self.assertEqual(envs.observation_space.shape, (5, len(envs.observation_channels)))
        self.assertEqual(envs.metadata["autoreset_mode"], AutoresetMode.NEXT_STEP)
        self.assertEqual(len(envs.action_channels), len(envs.action_scales))
        self.assertEqual(envs.episode_steps, 1000)
        self.assertEqual((envs.action_space.low.min(), envs.action_space.high.max()), (-1, 1))
        observations, infos = envs.reset(seed=3)
        self.assertEqual((observations.dtype, infos), (np.float32, {}))
        self.assertTrue(envs.observation_space.contains(observations))
        observations, rewards, over, cut, infos = envs.step(envs.action_space.sample())
        self.assertTrue(envs.observation_space.contains(observations))
        self.assertEqual((rewards.dtype, rewards.shape), (np.float64, (5,)))
        self.assertEqual((over.dtype, cut.dtype), (bool, bool))

    def test_arrays_are_fresh_or_the_same(self):
        for copy in (True, False):
            envs = taut.gym.make_vec(SPINE, 2, copy=copy)
            first, _ = envs.reset(seed=0)
            second = envs.step(np.zeros((2, 12)))[0]
            self.assertEqual(first is second, not copy)
        envs = taut.gym.make_vec(short(), 1)
        envs.reset(seed=0)
        results = [envs.step(np.zeros((1, 12)))[2:4] for _ in range(5)]
        self.assertEqual([bool(cut[0]) for _, cut in results], [False] * 4 + [True])

    def test_world_i_has_the_seed_plus_i_and_none_goes_on(self):
        envs, alone = taut.gym.make_vec(SPINE, 4), taut.gym.make_vec(SPINE, 1)
        together, _ = envs.reset(seed=7)
        for i in range(4):
            np.testing.assert_array_equal(alone.reset(seed=7 + i)[0][0], together[i])
        again, _ = envs.reset(seed=[7, 8, 9, 10])
        np.testing.assert_array_equal(again, together)
        self.assertFalse((envs.reset()[0] == together).all(axis=1).any())

    def test_a_restored_world_goes_on_as_it_would_have(self):
        envs, other = taut.gym.make_vec(short(), 3), taut.gym.make_vec(short(), 1, simd="scalar", seed=90)
        envs.reset(seed=5)
        acts = actions_of(envs, 9)
        envs.step(acts[0])
        saved = envs.save(2)
        self.assertIsInstance(saved, bytes)
        expected = [envs.step(a) for a in acts[1:]]  # through the end of the episode
        other.restore(saved)
        for step, a in zip(expected, acts[1:]):
            observations, rewards, over, cut, _ = other.step(a[2:])
            np.testing.assert_array_equal(observations[0], step[0][2])
            self.assertEqual((rewards[0], over[0], cut[0]), (step[1][2], step[2][2], step[3][2]))
        self.assertEqual(other.hash(0), envs.hash(2))
        alone = taut.gym.Env(SPINE)
        state = alone.save()
        first = alone.step(acts[0][0])[0]
        alone.restore(state)
        np.testing.assert_array_equal(alone.step(acts[0][0])[0], first)
        for wrong, world in ((saved[:-1], 0), (b"nothing", 0), (alone.save(), 0)):
            with self.assertRaises(taut.InputError):
                other.restore(wrong, world)
        with self.assertRaises(IndexError):
            envs.save(3)

    def test_actions_may_move_what_controllers_know(self):
        text = pathlib.Path(ROOT / "share/experiments" / "sine_hand_tuned.yaml").read_text()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "wave.yaml"
            path.write_text(text.replace("../", f"{ROOT}/share/") + """
environment:
  period_s: 0.02
  actions:
    - {each: impedance.inner_*.tension_offset_n, by: 5}
    - {all: impedance.sine.*.amplitude_m_per_s, by: 0.02, name: amplitude}
  observations: [cable/*/setpoint_n]
""")
            envs = taut.gym.make_vec(str(path), 2)
        self.assertEqual(len(envs.action_channels), 7)
        self.assertIn("impedance.inner_top_1.tension_offset_n", envs.action_channels[:6])
        self.assertEqual((envs.action_channels[6], envs.action_scales[6]), ("amplitude", 0.02))
        envs.reset(seed=0)
        actions = np.zeros(envs.action_space.shape, np.float32)
        actions[1] = 1
        observations = envs.step(actions)[0]
        self.assertGreater(np.abs(observations[1] - observations[0]).max(), 1)

    def test_a_masked_reset_leaves_all_others(self):
        envs, other = taut.gym.make_vec(SPINE, 3), taut.gym.make_vec(SPINE, 3)
        for e in (envs, other):
            e.reset(seed=1)
            e.step(np.ones((3, 12)))
        before, _ = other.reset(seed=1)
        np.testing.assert_array_equal(other.reset(options={"reset_mask": [False, False, True]})[0][:2], before[:2])
        for e in (envs, other):
            e.reset(seed=1)
            e.step(np.ones((3, 12)))
        envs.reset(seed=50, options={"reset_mask": np.array([False, True, False])})
        self.assertEqual([envs.hash(w) == other.hash(w) for w in range(3)], [True, False, True])
        self.assertEqual((envs.time_s(0), envs.time_s(1)), (0.01, 0.0))

    def test_next_step(self):
        envs = taut.gym.make_vec(short(), 2)
        envs.reset(seed=0)
        for _ in range(4):
            self.assertFalse(envs.step(np.zeros((2, 12)))[3].any())
        _, _, over, cut, infos = envs.step(np.zeros((2, 12)))
        self.assertTrue(cut.all() and not over.any())
        self.assertEqual(list(infos["end"]), [EpisodeEnd.TIME] * 2)
        self.assertEqual(list(infos["episode_steps"]), [5, 5])
        _, rewards, over, cut, _ = envs.step(np.ones((2, 12)))
        self.assertFalse(rewards.any() or over.any() or cut.any())
        self.assertEqual(envs.time_s(0), 0.0)

    def test_same_step(self):
        envs = taut.gym.make_vec(short(), 2, autoreset_mode=AutoresetMode.SAME_STEP)
        plain = taut.gym.make_vec(short(), 2, autoreset_mode="Disabled")
        for e in (envs, plain):
            e.reset(seed=0)
        total = np.zeros(2)
        for _ in range(5):
            observations, rewards, _, cut, infos = envs.step(np.zeros((2, 12)))
            last, same, _, same_cut, _ = plain.step(np.zeros((2, 12)))
            np.testing.assert_array_equal(rewards, same)
            total += rewards
        self.assertTrue(cut.all() and same_cut.all())
        np.testing.assert_array_equal(infos["final_obs"], last)
        self.assertTrue(infos["_final_obs"].all())
        np.testing.assert_allclose(infos["final_info"]["episode_return"], total, rtol=1e-12, atol=1e-15)
        self.assertFalse((observations == last).all())
        self.assertEqual(envs.time_s(0), 0.0)

    def test_disabled(self):
        envs = taut.gym.make_vec(short(), 1, autoreset_mode=AutoresetMode.DISABLED)
        envs.reset(seed=0)
        for _ in range(7):
            _, rewards, _, cut, _ = envs.step(np.zeros((1, 12)))
        self.assertEqual((rewards[0], bool(cut[0])), (0.0, True))

    def test_what_is_not_finite_ends_an_episode_and_is_never_returned(self):
        envs = taut.gym.make_vec(SPINE, 2)
        envs.reset(seed=0)
        actions = np.zeros((2, 12))
        actions[1, 3] = math.nan
        observations, rewards, over, _, infos = envs.step(actions)
        self.assertEqual(list(over), [False, True])
        self.assertEqual(infos["end"][1], EpisodeEnd.WRONG_ACTION)
        self.assertTrue(np.isfinite(observations).all() and np.isfinite(rewards).all())

    def test_one_environment(self):
        env, vector = taut.gym.Env(SPINE), taut.gym.make_vec(SPINE, 1)
        first, infos = env.reset(seed=5)
        np.testing.assert_array_equal(first, vector.reset(seed=5)[0][0])
        action = env.action_space.sample()
        observation, reward, over, cut, _ = env.step(action)
        seen, rewards, *_ = vector.step(action[None])
        np.testing.assert_array_equal(observation, seen[0])
        self.assertEqual((reward, over, cut, infos), (rewards[0], False, False, {}))
        self.assertIsInstance(reward, float)
        env = taut.gym.Env(short())
        env.reset(seed=0)
        self.assertEqual([env.step(0 * action)[3] for _ in range(7)], [False] * 4 + [True] * 3)


class Bits(unittest.TestCase):
    def test_without_actions_it_is_the_run_of_the_episode(self):
        envs = taut.gym.make_vec(SPINE, 3)
        envs.reset(seed=11)
        for _ in range(20):
            envs.step(np.zeros((3, 12)))
        for world in (0, 2):
            episode = envs.experiment(world)
            episode.duration_s = 0.2
            self.assertEqual(taut.run(episode).state_hash, envs.hash(world))

    def test_threads_lanes_numbers_and_company_do_not_matter(self):
        def hashes(n, **how):
            envs = taut.gym.make_vec(SPINE, n, **how)
            envs.reset(seed=2)
            for action in actions_of(taut.gym.make_vec(SPINE, 9), 12):
                envs.step(action[:n])
            return [envs.hash(w) for w in range(n)]

        all_of_them = hashes(9)
        self.assertEqual(hashes(9, threads=2), all_of_them)
        self.assertEqual(hashes(9, simd="scalar"), all_of_them)
        self.assertEqual(hashes(9, dtype=np.float64), all_of_them)
        self.assertEqual(hashes(2), all_of_them[:2])


class Callbacks(unittest.TestCase):
    def test_rewards_and_observations_of_ones_own(self):
        seen = []

        def observe(rows, observations):
            observations[rows != 0, -1] = 42

        def judge(rows, observations, actions, rewards, terminated):
            seen.append(actions.copy())
            rewards += 1
            terminated[0] = 1

        envs = taut.gym.make_vec(SPINE, 2, own_observations=1, observe=observe, judge=judge)
        plain = taut.gym.make_vec(SPINE, 2)
        self.assertTrue((envs.reset(seed=0)[0][:, -1] == 42).all())
        plain.reset(seed=0)
        observations, rewards, over, _, infos = envs.step(np.full((2, 12), 0.5))
        np.testing.assert_allclose(rewards, plain.step(np.full((2, 12), 0.5))[1] + 1, rtol=1e-12)
        self.assertEqual(list(over), [True, False])
        self.assertEqual(infos["end"][0], EpisodeEnd.CALLED)
        self.assertTrue((observations[:, -1] == 42).all() and (seen[0] == 0.5).all())

    def test_what_a_callback_raises_comes_out_of_step(self):
        def judge(*_):
            raise KeyError("mine")

        envs = taut.gym.make_vec(SPINE, 2, judge=judge)
        envs.reset(seed=0)
        for _ in range(2):
            with self.assertRaisesRegex(KeyError, "mine"):
                envs.step(np.zeros((2, 12)))


class WrongCalls(unittest.TestCase):
    def test_are_named(self):
        envs = taut.gym.make_vec(SPINE, 2)
        envs.reset(seed=0)
        for call, why in ((lambda: envs.step(np.zeros((2, 11))), r"actions.*\(2, 11\).*\(2, 12\)"),
                          (lambda: envs.reset(seed=[1]), r"seeds.*\(2,\)"),
                          (lambda: envs.reset(seed=-1), "0 or more"),
                          (lambda: envs.reset(options={"mask": 1}), "reset_mask"),
                          (lambda: envs.reset(options={"reset_mask": [True]}), "mask"),
                          (lambda: taut.gym.make_vec(SPINE, 0), "expected 1 to 1000000000"),
                          (lambda: taut.gym.make_vec(SPINE, 1, dtype=np.int32), "float32 or float64"),
                          (lambda: taut.gym.make_vec(SPINE, 1, autoreset_mode="never"), "never"),
                          (lambda: taut.gym.make_vec(str(ROOT / "share/models/prism3.yaml"), 1), "a model"),
                          (lambda: taut.gym.make_vec(str(ROOT / "share/experiments/push_20n.yaml"), 1), "environment")):
            with self.assertRaisesRegex(ValueError, why):
                call()
        self.assertRaises(IndexError, lambda: envs.hash(2))
        envs.close()
        self.assertRaisesRegex(RuntimeError, "closed", lambda: envs.step(np.zeros((2, 12))))

    def test_a_forked_child_is_told(self):
        envs = taut.gym.make_vec(SPINE, 16, threads=2)
        envs.reset(seed=0)
        child = os.fork()
        if child == 0:
            try:
                envs.step(np.zeros((16, 12)))
            except RuntimeError as error:
                os._exit(0 if "fork" in str(error) else 1)
            os._exit(2)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)


class WithGymnasium(unittest.TestCase):
    def setUp(self):
        try:
            import gymnasium  # noqa: F401
        except ImportError:
            self.skipTest("no gymnasium")

    def test_its_checker_finds_nothing(self):
        from gymnasium.utils.env_checker import check_env
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", ".*Box observation space")  # it warns about infinite bounds
            check_env(taut.gym.Env(short()), skip_render_check=True)

    def test_many_are_as_its_own_vectors_of_single_ones(self):
        import gymnasium
        if not hasattr(gymnasium.vector, "AutoresetMode"):
            self.skipTest("gymnasium before 1.1: its vectors have one mode only")
        for mode in (AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP):
            single = gymnasium.vector.SyncVectorEnv([lambda: taut.gym.Env(short())] * 3, autoreset_mode=mode)
            many = taut.gym.make_vec(short(), 3, autoreset_mode=mode)
            np.testing.assert_array_equal(single.reset(seed=4)[0], many.reset(seed=4)[0])
            for action in actions_of(many, 12):
                for one, other in zip(single.step(action)[:4], many.step(action)[:4]):
                    np.testing.assert_array_equal(one, other)


class OtherGymnasiums(unittest.TestCase):
    """Stubs of versions that are not installed here, with the names that taut.gym uses"""

    def imported(self, version, init=""):
        """Returns the output of a program that imports taut.gym with this stub of gymnasium."""
        spaces = (ROOT / "python/taut/_spaces.py").read_text()
        files = {"__init__.py": f"{init}\n__version__ = {version!r}\nclass Env:\n    def reset(self, *, seed=None): pass\n",
                 "spaces.py": spaces, "vector/utils.py": spaces, "vector/__init__.py": "class VectorEnv: pass\n"}
        text = ("import gymnasium, gymnasium.vector, taut.gym\n"
                f"one, many = taut.gym.Env({SPINE!r}), taut.gym.make_vec({SPINE!r}, 2, autoreset_mode='SameStep')\n"
                "one.reset(seed=1), many.reset(seed=1)\n"
                "print(isinstance(one, gymnasium.Env), isinstance(many, gymnasium.vector.VectorEnv))\n")
        with tempfile.TemporaryDirectory() as folder:
            for name, content in files.items():
                path = pathlib.Path(folder, "gymnasium", name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(content)
            path = os.pathsep.join([folder, os.environ.get("PYTHONPATH", "")])
            ran = subprocess.run([sys.executable, "-c", text], env=os.environ | {"PYTHONPATH": path}, text=True,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=100)
        return ran.stdout

    def test_those_without_autoreset_modes_have_its_classes(self):
        for version in ("0.29.1", "1.0.0"):
            self.assertEqual(self.imported(version), "True True\n")

    def test_one_that_is_too_old_is_named(self):
        self.assertIn("ImportError: gymnasium 0.28.1 is installed; taut.gym needs 0.29 or newer", self.imported("0.28.1"))

    def test_one_that_cannot_be_imported_is_not_hidden(self):
        self.assertIn("ModuleNotFoundError: No module named 'cloud_pickle'", self.imported("1.1.0", "import cloud_pickle"))


if __name__ == "__main__":
    sys.argv.pop(1)
    warnings.simplefilter("error")
    unittest.main()
