"""examples/ppo.py: sums against independent computations, a task with a known optimum, three updates of the robot, and
runs compared with the sine"""

import contextlib
import csv
import importlib.util
import io
import math
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

if importlib.util.find_spec("torch") is None:
    print("skipped: no torch (python3-torch)")
    sys.exit(77)

import numpy as np  # noqa: E402
import torch  # noqa: E402

import taut  # noqa: E402
import taut.gym  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "examples"), str(ROOT / "benchmarks")]
import ppo  # noqa: E402
import ppo_play  # noqa: E402
from validation import rolling  # noqa: E402

PROGRAM = [sys.executable, str(ROOT / "examples" / "ppo.py")]
FEW = ppo.Settings(worlds=8, periods=8)


class Aim:
    """Environment with a known optimal policy and value. The reward is 1 less the squared distance of the action from
    twice the first observation. Episodes have four periods; the second observation marks odd worlds, whose episodes
    end with a failure."""

    observation_channels, action_channels = ["it", "odd"], ["aim"]
    period_s, episode_steps = 0.5, 4

    def __init__(self, worlds):
        self.num_envs, self.action_space = worlds, taut.gym.Box(-1, 1, (worlds, 1))
        self.random, self.step_number = np.random.default_rng(0), 0
        self.odd = np.arange(worlds) % 2 == 1

    def _draw(self):
        self.seen = np.stack([self.random.uniform(-0.4, 0.4, self.num_envs), self.odd], 1)
        return self.seen.astype(np.float32)

    def reset(self, seed=None, options=None):
        return self._draw(), {}

    def step(self, actions):
        rewards = 1 - np.square(np.asarray(actions, np.float64)[:, 0] - 2 * self.seen[:, 0])
        self.step_number += 1
        ended = np.full(self.num_envs, self.step_number % 4 == 0)
        infos = {"final_obs": self._draw(), "final_info": {"episode_return": rewards}} if ended[0] else {}
        return self._draw(), rewards, ended & self.odd, ended & ~self.odd, infos


class Sums(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(0)

    def test_advantages_are_the_weighted_sum_of_all_that_follows(self):
        n, worlds = 7, 3
        rewards, values, after = torch.randn(3, n, worlds).unbind()
        ended = torch.rand(n, worlds) < 0.3
        found = ppo.advantages(rewards, values, after, ended, ppo.Settings(discount=0.9, trace=0.7))
        for w in range(worlds):
            for t in range(n):
                expected = 0.0
                for ahead in range(t, n):
                    surprise = float(rewards[ahead, w] + 0.9 * after[ahead, w] - values[ahead, w])
                    expected += (0.9 * 0.7) ** (ahead - t) * surprise
                    if ended[ahead, w]:
                        break
                self.assertAlmostEqual(found[t, w].item(), expected, places=5)

    def test_scales_are_those_of_all_that_was_seen(self):
        policy = ppo.Policy(["a", "b", "c"], 1, FEW)
        seen = [torch.randn(n, 5, 3) * torch.tensor([1.0, 20.0, 0.1]) + torch.tensor([0.0, 3.0, 7.0]) for n in (2, 9, 4)]
        for part in seen:
            policy.learn_scales(part)
        of_all = torch.cat(seen).reshape(-1, 3).double()
        np.testing.assert_allclose(policy.mean, of_all.numpy().mean(0), rtol=1e-12)
        np.testing.assert_allclose(policy.variance, of_all.numpy().var(0), rtol=1e-12)
        scaled = policy.scaled(of_all.float())
        np.testing.assert_allclose(scaled.mean(0), 0, atol=1e-4)
        np.testing.assert_allclose(scaled[:, :2].std(0, unbiased=False), 1, atol=2e-3)
        self.assertEqual(policy.scaled(torch.tensor([[1e9, 3.0, -1e9]]))[0, [0, 2]].tolist(), [5, -5])

    def test_where_the_robot_is_does_not_matter(self):
        channels = ["node/a/position_x_m", "node/a/position_z_m", "node/a/velocity_x_m_per_s", "node/b/position_x_m",
                    "system/com_x_m", "system/com_z_m"]
        policy = ppo.Policy(channels, 1, FEW)
        there = np.array([[7.5, 1.0, 3.0, 8.5, 7.0, 0.5]], np.float32)
        self.assertEqual(policy.look(there).tolist(), [[0.5, 1.0, 3.0, 1.5, 0.0, 0.5]])
        self.assertEqual(there[0, 0], 7.5)

    def test_chances_are_those_of_a_normal_distribution(self):
        policy = ppo.Policy(["a"], 2, ppo.Settings(first_deviation=0.3))
        chances = policy(torch.tensor([[0.5]]))
        mean = policy.actor(torch.tensor([[0.5]]))[0].tolist()
        expected = math.prod(math.exp(-0.5 * ((x - m) / 0.3) ** 2) / (0.3 * math.sqrt(2 * math.pi))
                             for x, m in zip((0.2, -0.7), mean))
        found = chances.log_prob(torch.tensor([[0.2, -0.7]])).sum(-1).exp().item()
        self.assertAlmostEqual(found, expected, places=5)

    def test_the_gradient_of_the_loss_is_its_difference_quotient(self):
        policy = ppo.Policy(["a", "b"], 2, FEW).double()
        scaled, actions = torch.randn(64, 2).double(), torch.randn(64, 2).double()
        advantage = torch.randn(64).double()
        with torch.no_grad():
            before = policy(scaled).log_prob(actions).sum(-1) + 0.3 * torch.randn(64)

        def loss():
            return ppo.loss_of_policy(policy(scaled).log_prob(actions).sum(-1), before, advantage, 0.2)

        loss().backward()
        for weights in (policy.log_deviation, policy.actor[0].weight, policy.actor[4].bias):
            flat, at = weights.data.view(-1), weights.numel() // 2
            worth = []
            for change in (1e-5, -1e-5):
                flat[at] += change
                worth.append(loss().item())
                flat[at] -= change
            self.assertAlmostEqual(weights.grad.view(-1)[at].item(), (worth[0] - worth[1]) / 2e-5, delta=1e-6)

    def test_the_loss_wants_good_actions_likelier_and_no_more_than_clipped(self):
        for ratio, advantage, slope in ((1.0, 2.0, -2.0), (1.0, -2.0, 2.0), (1.3, 2.0, 0.0), (0.7, -2.0, 0.0),
                                        (1.3, -2.0, 2.6), (0.7, 2.0, -1.4)):
            log_chance = torch.tensor([math.log(ratio)], requires_grad=True)
            ppo.loss_of_policy(log_chance, torch.zeros(1), torch.tensor([advantage]), 0.2).backward()
            self.assertAlmostEqual(log_chance.grad.item(), slope, places=5)

    def test_an_update_depends_on_advantages_beside_each_other_alone(self):
        given = [torch.randn(64, 2), torch.randn(64, 1), torch.randn(64)]
        advantage, worth, found = torch.randn(64), torch.randn(64), []
        for changed in (advantage, 3 * advantage + 5):
            torch.manual_seed(1)
            policy = ppo.Policy(["a", "b"], 1, FEW)
            optimizer = torch.optim.SGD(policy.parameters(), lr=1e-3)
            found.append(ppo.update(policy, optimizer, *given, changed, worth, FEW))
            found.append(policy.actor[0].weight.detach().numpy())
        self.assertGreater(found[0], 0)
        self.assertAlmostEqual(found[0], found[2], delta=1e-4 * found[0])
        np.testing.assert_allclose(found[1], found[3], atol=1e-6)


class Collecting(unittest.TestCase):
    def test_what_followed_an_end_is_the_last_of_its_own_episode_or_nothing(self):
        torch.manual_seed(1)
        envs, policy = Aim(4), ppo.Policy(Aim.observation_channels, 2, FEW)  # which uses the first observation only
        steps = []
        true_step = envs.step
        envs.step = lambda actions: steps.append(true_step(actions)) or steps[-1]
        columns, seen, returns = ppo.collect(envs, policy, policy.look(envs.reset()[0]), ppo.Settings(periods=6))
        raw, scaled, actions, log_chances, values, rewards, after, ended = columns
        with torch.no_grad():
            def worth(observations):
                return policy.critic(policy.scaled(torch.from_numpy(observations)))[:, 0]
            for t, (found, reward, failed, cut, infos) in enumerate(steps):
                expected = worth(infos["final_obs"]) * torch.from_numpy(~failed) if t == 3 else worth(found)
                np.testing.assert_allclose(after[t], expected, atol=1e-6)
                np.testing.assert_allclose(rewards[t], reward, atol=1e-6)
                np.testing.assert_array_equal(ended[t], failed | cut)
                np.testing.assert_array_equal(raw[t + 1] if t < 5 else seen, found)
            np.testing.assert_allclose(values, policy.worth(scaled), atol=1e-6)
            np.testing.assert_allclose(log_chances, policy(scaled).log_prob(actions).sum(-1), atol=1e-5)
        np.testing.assert_allclose(returns, steps[3][1])

    def test_worlds_begin_all_over_their_episodes(self):
        envs = taut.gym.make_vec(str(ppo.TASK), 8, autoreset_mode="SameStep")
        ppo.begin(envs, ppo.Policy(envs.observation_channels, 24, FEW), FEW, 1)
        np.testing.assert_allclose([envs.time_s(w) for w in range(8)], 20 * (1 - np.arange(8) / 8) - 0.05, atol=1e-9)


class Learning(unittest.TestCase):
    def test_what_is_best_is_known_and_found(self):
        s = ppo.Settings(worlds=64, periods=8, hidden=16, first_rate=3e-3, discount=0.5)
        learner = ppo.Learner(Aim(64), 0, s)
        for said in learner.learn(Aim(64)):
            if said["update"] == 100:
                break
        seen = torch.tensor([[-0.3, 0.0], [0.0, 0.0], [0.3, 0.0], [-0.3, 1.0], [0.0, 1.0], [0.3, 1.0]])
        with torch.no_grad():
            means = learner.policy(learner.policy.scaled(seen)).mean[:, 0]
            worth = learner.policy.worth(learner.policy.scaled(seen)).reshape(2, 3).mean(1)
        np.testing.assert_allclose(means, [-0.6, 0, 0.6] * 2, atol=0.1)
        self.assertLess(said["deviation"], 0.25)
        self.assertAlmostEqual(said["per_s"], (1 - said["deviation"] ** 2) / Aim.period_s, delta=0.05)
        # 1 + 1/2 + 1/4 ... for truncated episodes; the mean over four periods for failing ones, as time is not observed
        both = np.array([2, (1 + 1.5 + 1.75 + 1.875) / 4]) * (1 - said["deviation"] ** 2)
        np.testing.assert_allclose(worth, both, atol=0.1)

    def test_three_updates_of_the_robot_are_finite_and_the_same_again(self):
        def three(seed, threads):
            envs = taut.gym.make_vec(str(ppo.TASK), FEW.worlds, threads=threads, autoreset_mode="SameStep")
            learner = ppo.Learner(envs, seed, FEW)
            start = [x.clone() for x in learner.policy.parameters()]
            said = [said for said, _ in zip(learner.learn(envs), range(3))]
            return start, learner.policy.state_dict(), [{k: v for k, v in one.items() if k != "processor_s"} for one in said]

        start, policy, said = three(1, 1)
        _, again, said_again = three(1, 2)
        _, other, _ = three(2, 1)
        self.assertEqual([one["update"] for one in said], [1, 2, 3])
        self.assertEqual(said[-1]["periods"], 3 * FEW.worlds * FEW.periods)
        for name, value in policy.items():
            self.assertTrue(torch.isfinite(value).all(), name)
            self.assertTrue(torch.equal(value, again[name]), name)
        self.assertTrue(all(math.isfinite(one["divergence"]) and 0 < one["divergence"] < 1 for one in said))
        np.testing.assert_equal(said, said_again)
        self.assertFalse(torch.equal(policy["actor.4.weight"], other["actor.4.weight"]))
        for before, after in zip(start, list(policy.values())[:len(start)]):
            self.assertFalse(torch.equal(before, after))


class Keeping(unittest.TestCase):
    def test_all_that_learning_goes_on_from_is_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "policy.pt"
            first = ppo.Learner(Aim(8), 5, FEW)
            for said in first.learn(Aim(8)):
                if said["update"] == 3:
                    break
            first.optimizer.param_groups[0]["lr"] = 1.25e-4
            first.save(path)
            found = []
            for _ in range(2):
                again = ppo.Learner(Aim(8), 5, FEW)
                at_the_start = torch.get_rng_state()
                again.load(path)
                self.assertEqual(again.about(), first.about())
                self.assertEqual((again.updates, again.about()["rate"]), (3, 1.25e-4))
                self.assertFalse(torch.equal(torch.get_rng_state(), at_the_start))
                for kept, own in zip(again.optimizer.state_dict()["state"].values(),
                                     first.optimizer.state_dict()["state"].values()):
                    self.assertTrue(torch.equal(kept["exp_avg_sq"], own["exp_avg_sq"]))
                self.assertEqual(len(again.optimizer.state_dict()["state"]), 13)
                self.assertEqual(next(again.learn(Aim(8)))["update"], 4)
                found.append(again.policy.state_dict())
            for name, value in found[0].items():
                self.assertTrue(torch.equal(value, found[1][name]), name)
            before = path.read_bytes()
            with unittest.mock.patch("torch.save", side_effect=OSError("no space")), self.assertRaises(OSError):
                again.save(path)
            self.assertEqual(path.read_bytes(), before)


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def run_it(self, *arguments, status=0):
        ran = subprocess.run([*PROGRAM, "--out", self.folder, *arguments], capture_output=True, text=True)
        self.assertEqual(ran.returncode, status, ran.stdout + ran.stderr)
        return ran.stdout + ran.stderr

    def test_saves_goes_on_and_plays(self):
        self.run_it("--updates", "1", "--worlds", "8")
        first = torch.load(self.folder / "policy.pt", weights_only=True)
        self.assertIn("goes on after update 1", self.run_it("--updates", "2", "--worlds", "8"))
        with open(self.folder / "curve.csv", newline="") as file:
            self.assertEqual([row["update"] for row in csv.DictReader(file)], ["1", "2"])
        self.run_it("--updates", "2", "--worlds", "8")
        second = torch.load(self.folder / "policy.pt", weights_only=True)
        counts = [int(kept["policy"]["count"]) for kept in (first, second)]
        self.assertEqual(counts[1] - counts[0], 8 * ppo.Settings.periods)
        for worse, why in ((["--seed", "2", "--worlds", "8"], "other seed"), (["--worlds", "9"], "other settings")):
            self.assertIn(why, self.run_it("--updates", "3", *worse, status=3))
        said = self.run_it("--play", "--starts", "2", "--seconds", "3")
        for number in range(2):
            way = {}
            for name in ("policy", "sine"):
                com = taut.run(taut.load(str(self.folder / "play" / f"{name}_{number}.yaml"))).trace
                way[name] = math.hypot(*(com[f"system/com_{k}_m"][-1] - com[f"system/com_{k}_m"][0] for k in "xy"))
            self.assertIn(f"{number:5d} {way['policy']:7.1f} {way['sine']:7.1f}", said)
        (self.folder / "policy.pt").write_bytes((self.folder / "policy.pt").read_bytes()[:5000])
        self.assertIn("policy.pt", self.run_it("--play", status=3))

    def test_ctrl_c_saves(self):
        program = subprocess.Popen([*PROGRAM, "--out", self.folder, "--worlds", "8"], stdout=subprocess.PIPE, text=True)
        self.assertIn("update 10:", program.stdout.readline())
        program.send_signal(signal.SIGINT)
        said, _ = program.communicate(timeout=60)
        self.assertEqual((program.returncode, "saved to" in said), (0, True))
        last = [line for line in said.splitlines() if line.startswith("update")][-1]
        number = int(last.split()[1].rstrip(":"))
        self.assertGreaterEqual(number, 10)
        self.assertIn(f"goes on after update {number}", self.run_it("--updates", "1", "--worlds", "8"))

    def test_what_is_wrong_is_named(self):
        def refused(*arguments):
            with contextlib.redirect_stderr(io.StringIO()) as said, contextlib.redirect_stdout(said), \
                    self.assertRaises(SystemExit) as ended:
                with unittest.mock.patch("sys.argv", ["ppo.py", "--out", str(self.folder), *arguments]):
                    ppo.main()
            return ended.exception.code, said.getvalue()

        for arguments, why in ((["--worlds", "0"], "--worlds 0: more than 0"), (["--minutes", "nan"], "--minutes nan"),
                               (["--updates", "-1"], "--updates -1: 0 or more"), (["--seconds", "inf"], "--seconds inf"),
                               (["--starts", "some"], "--starts"), (["--what"], "--what")):
            status, said = refused(*arguments)
            self.assertEqual(status, 2, arguments)
            self.assertIn(why, said)
        status, said = refused("--play")
        self.assertEqual((status, "policy.pt" in said), (3, True))
        (self.folder / "play").write_text("in the way")
        ppo.Learner(taut.gym.make_vec(str(ppo.TASK)), 4, ppo.Settings()).save(self.folder / "policy.pt")
        status, said = refused("--play")
        self.assertEqual((status, "play" in said), (3, True))
        (self.folder / "play").unlink()
        status, said = refused("--play", "--seconds", "0.0301")
        self.assertEqual((status, "duration_s" in said), (3, True), said)
        ppo.Learner(Aim(2), 1, ppo.Settings()).save(self.folder / "policy.pt")
        status, said = refused("--play")
        self.assertEqual((status, "other channels" in said), (3, True), said)


class BesideTheSine(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_what_the_policy_did_is_what_taut_run_does(self):
        torch.manual_seed(3)
        envs = taut.gym.make_vec(str(ppo.TASK))
        policy = ppo.Policy(envs.observation_channels, 24, FEW)
        with torch.no_grad():
            policy.actor[4].weight.mul_(300)  # mostly outside of -1..1
        make, made = taut.gym.make_vec, []
        with unittest.mock.patch("taut.gym.make_vec", lambda *a, **how: made.append(make(*a, **how)) or made[-1]):
            way_m = ppo_play.roll(policy, ppo.TASK, 3, 5, self.folder)
        ran = taut.run(taut.load(str(self.folder / "policy_3.yaml")))
        self.assertEqual(ran.state_hash, made[0].hash())
        com = ran.trace
        again_m = math.hypot(*(com[f"system/com_{k}_m"][-1] - com[f"system/com_{k}_m"][0] for k in "xy"))
        self.assertAlmostEqual(way_m, again_m, delta=1e-6)
        self.assertGreater(way_m, 0.1)

    def test_starts_are_those_of_the_page(self):
        for number in range(4):
            keys, parameters = rolling.start(number)
            text = pathlib.Path(ppo_play.write_start(self.folder / "start.yaml", ppo_play.SINE, number, 60)).read_text()
            self.assertIn(keys, text)
            self.assertEqual("start_noise" in text, number > 0)
            self.assertEqual(taut.load(str(self.folder / "start.yaml")).parameters["ground_friction"],
                             float(parameters.get("ground_friction", 0.5)))

    def test_both_begin_alike_and_the_sine_is_the_one_of_the_page(self):
        traces = [taut.run(taut.load(ppo_play.write_start(self.folder / f"{base.stem}.yaml", base, 5, 0.1))).trace
                  for base in (ppo_play.SINE, ppo_play.PLAIN, ppo.TASK)]
        for channel in ("system/com_x_m", "system/com_z_m", "body/c/position_y_m", "cable/al_cl/tension_n"):
            for trace in traces[1:]:
                self.assertAlmostEqual(trace[channel][0], traces[0][channel][0], delta=1e-6, msg=channel)
        as_it_is = ppo_play.roll_by_sine(0, 60, self.folder)
        page = (ROOT / "docs" / "validation" / "rolling.md").read_text()
        self.assertIn(f"| level ground | {as_it_is:.1f} |", page)


if __name__ == "__main__":
    sys.argv.pop(1)
    torch.set_num_threads(1)
    torch.use_deterministic_algorithms(True)
    unittest.main()
