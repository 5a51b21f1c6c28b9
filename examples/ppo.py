"""Proximal policy optimization (PPO) in one file: trains a six-strut robot to roll, and compares it with the best sine
gait found by `taut learn`.

    python3 examples/ppo.py --minutes 10    trains; Ctrl-C saves, and the same command resumes; files are in runs/ppo
    python3 examples/ppo.py --play          compares with the sine: a minute from twelve starts, shown by `taut view`

Needs taut's Python module (docs/python.md), python3-torch, and libopenblas0-serial, without which torch is slow.
Source: Schulman, Wolski, Dhariwal, Radford and Klimov, arXiv:1707.06347.
"""

import argparse
import csv
import dataclasses
import json
import math
import os
import pathlib
import signal
import statistics
import sys
import time

import numpy as np
import torch
from torch import nn
from torch.distributions import Normal, kl_divergence

import taut
import taut.gym

TASK = pathlib.Path(__file__).resolve().parents[1] / "share/experiments" / "learn_roll_ahead.yaml"


@dataclasses.dataclass(frozen=True)
class Settings:
    worlds: int = 256             # in parallel
    periods: int = 32             # per world and update
    epochs: int = 5               # passes over these data per update
    parts: int = 4                # minibatches per epoch
    discount: float = 0.99        # discount factor per period (gamma)
    trace: float = 0.95           # lambda of generalized advantage estimation
    clip: float = 0.2             # largest relative change of an action's probability that has a gradient
    divergence: float = 0.02      # target Kullback-Leibler divergence per update; adapts the learning rate
    first_rate: float = 3e-4
    first_deviation: float = 0.6  # initial standard deviation of actions
    hidden: int = 64              # units in each of two layers


def network(inputs, hidden, outputs, last_gain):
    layers = [nn.Linear(inputs, hidden), nn.Tanh(), nn.Linear(hidden, hidden), nn.Tanh(), nn.Linear(hidden, outputs)]
    for layer, gain in zip(layers[::2], (math.sqrt(2), math.sqrt(2), last_gain)):
        nn.init.orthogonal_(layer.weight, gain)
        nn.init.zeros_(layer.bias)
    return nn.Sequential(*layers)


class Policy(nn.Module):
    """Actor and critic: from observations to the distribution of actions, and to the value of the state."""

    def __init__(self, channels, actions, s):
        super().__init__()
        n = len(channels)
        # Horizontal positions are relative to the center of mass: the task does not depend on the robot's place.
        self.center = {channels.index(f"system/com_{k}_m"):
                       [i for i, name in enumerate(channels) if name.endswith((f"position_{k}_m", f"com_{k}_m"))]
                       for k in "xy" if f"system/com_{k}_m" in channels}
        self.actor, self.critic = network(n, s.hidden, actions, 0.01), network(n, s.hidden, 1, 1.0)
        self.log_deviation = nn.Parameter(torch.full((actions,), math.log(s.first_deviation)))
        for name, start in ("mean", torch.zeros(n)), ("variance", torch.ones(n)), ("count", torch.zeros(())):
            self.register_buffer(name, start.double())

    def look(self, observations):
        """Returns observations as a tensor, with horizontal positions relative to the center of mass."""
        seen = torch.from_numpy(np.array(observations, np.float32))
        for at, columns in self.center.items():
            seen[..., columns] -= seen[..., [at]]
        return seen

    def scaled(self, seen):
        """Returns normalized observations: standard deviations from the mean of all previous ones."""
        return ((seen - self.mean.float()) / (self.variance.float().sqrt() + 1e-3)).clamp(-5, 5)

    def learn_scales(self, seen):
        """Updates mean and variance by new observations."""
        seen = seen.reshape(-1, len(self.mean)).double()
        n, apart, total = len(seen), seen.mean(0) - self.mean, self.count + len(seen)
        self.variance = (self.variance * self.count + seen.var(0, unbiased=False) * n
                         + apart.square() * self.count * n / total) / total
        self.mean, self.count = self.mean + apart * n / total, total

    def forward(self, scaled):
        """Returns the normal distribution of actions."""
        return Normal(self.actor(scaled), self.log_deviation.exp(), validate_args=False)

    def worth(self, scaled):
        return self.critic(scaled).squeeze(-1)


def begin(envs, policy, s, seed):
    """Staggers the episodes of the worlds: world i is reset after i / n of an episode. Until then actions are random,
    and a new policy computes the scales of observations from them."""
    drawn, n, seen = np.random.default_rng(seed), envs.num_envs, []
    envs.reset(seed=seed)
    for k in range(envs.episode_steps):
        observations, *_ = envs.step(drawn.normal(0, s.first_deviation, envs.action_space.shape))
        mask = np.arange(n) * envs.episode_steps // n == k
        if mask.any():
            observations, _ = envs.reset(options={"reset_mask": mask})
        if k % 10 == 0:
            seen.append(policy.look(observations))
    if not policy.count:
        policy.learn_scales(torch.stack(seen))
    return policy.look(observations)


def collect(envs, policy, seen, s):
    """Runs some periods of all worlds; returns tensors (periods, worlds, ...), next observations, episode returns."""
    rows, returns = [], []
    with torch.no_grad():
        for _ in range(s.periods):
            scaled = policy.scaled(seen)
            chances = policy(scaled)
            actions = chances.sample()
            found, rewards, failed, cut, infos = envs.step(actions.numpy())
            found, failed, ended = policy.look(found), torch.from_numpy(failed), torch.from_numpy(failed | cut)
            after = policy.worth(policy.scaled(found))
            if ended.any():  # `found` is the next episode's; truncated ones keep their last value
                last = policy.worth(policy.scaled(policy.look(infos["final_obs"])))
                after = torch.where(ended, torch.where(failed, 0.0, last), after)
                returns += infos["final_info"]["episode_return"][ended.numpy()].tolist()
            rows.append((seen, scaled, actions, chances.log_prob(actions).sum(-1), policy.worth(scaled),
                         torch.from_numpy(rewards.astype(np.float32)), after, ended))
            seen = found
    return [torch.stack(column) for column in zip(*rows)], seen, returns


def advantages(rewards, values, after, ended, s):
    """Returns generalized advantage estimates (arXiv:1506.02438):
    A_t = d_t + discount trace A_(t+1), with d_t = r_t + discount V(next state) - V(state)."""
    surprises, sums, ahead = rewards + s.discount * after - values, [], torch.zeros_like(rewards[0])
    for surprise, end in zip(reversed(surprises), reversed(ended)):
        ahead = surprise + s.discount * s.trace * torch.where(end, 0.0, ahead)
        sums.append(ahead)
    return torch.stack(sums[::-1])


def loss_of_policy(log_chance, log_chance_before, advantage, clip):
    """Returns the clipped surrogate loss: minus the gain by changed probabilities of actions, limited by `clip`."""
    ratio = (log_chance - log_chance_before).exp()
    return -torch.minimum(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage).mean()


def update(policy, optimizer, scaled, actions, log_chances, advantage, worth, s):
    """Runs some epochs of gradient steps; returns the Kullback-Leibler divergence from the previous policy."""
    with torch.no_grad():
        before = policy(scaled)
    for _ in range(s.epochs):
        for part in torch.randperm(len(scaled)).chunk(s.parts):
            a = (advantage[part] - advantage[part].mean()) / (advantage[part].std() + 1e-8)
            log_chance = policy(scaled[part]).log_prob(actions[part]).sum(-1)
            wrong = (policy.worth(scaled[part]) - worth[part]).square().mean()
            optimizer.zero_grad()
            (loss_of_policy(log_chance, log_chances[part], a, s.clip) + 0.5 * wrong).backward()
            nn.utils.clip_grad_norm_(policy.parameters(), 1.0)
            optimizer.step()
    with torch.no_grad():
        return kl_divergence(before, policy(scaled)).sum(-1).mean().item()


class Learner:
    """Policy with all data that are needed to resume training."""

    def __init__(self, envs, seed, s):
        torch.manual_seed(seed)
        self.s, self.seed, self.channels = s, seed, list(envs.observation_channels)
        self.policy = Policy(self.channels, len(envs.action_channels), s)
        self.optimizer = torch.optim.Adam(self.policy.parameters(), lr=s.first_rate, eps=1e-5)
        self.updates, self.processor_s = 0, 0.0

    def about(self):
        return {"seed": self.seed, "settings": dataclasses.asdict(self.s), "channels": self.channels,
                "updates": self.updates, "processor_s": self.processor_s, "rate": self.optimizer.param_groups[0]["lr"]}

    def save(self, path):
        """Writes a new file and then replaces the previous one, so that an interrupted write loses nothing."""
        torch.save({"about": json.dumps(self.about()), "policy": self.policy.state_dict(),
                    "moments": self.optimizer.state_dict()["state"]}, path.with_suffix(".new"))
        os.replace(path.with_suffix(".new"), path)

    def load(self, path, same=("seed", "settings", "channels")):
        """Restores the state of `save`."""
        try:
            kept = torch.load(path, weights_only=True)  # numbers and names only: executes no code
            about, own = json.loads(kept["about"]), self.about()
            differ = [name for name in same if about[name] != own[name]]
            if differ:
                raise ValueError(f"learned with other {', '.join(differ)}; take another --out")
            self.policy.load_state_dict(kept["policy"])
            self.optimizer.load_state_dict({**self.optimizer.state_dict(), "state": kept["moments"]})
            self.optimizer.param_groups[0]["lr"] = about["rate"]
            self.updates, self.processor_s = about["updates"], about["processor_s"]
        except Exception as error:
            print(f"{path}: {error}", file=sys.stderr)
            sys.exit(3)
        torch.manual_seed(self.seed + self.updates)

    def learn(self, envs):
        """Trains without end; yields the statistics of each update."""
        policy, group, started_s = self.policy, self.optimizer.param_groups[0], time.process_time() - self.processor_s
        seen = begin(envs, policy, self.s, self.seed + self.updates)
        while True:
            columns, seen, returns = collect(envs, policy, seen, self.s)
            raw, scaled, actions, log_chances, values, rewards, after, ended = columns
            advantage = advantages(rewards, values, after, ended, self.s)
            flat = [x.flatten(0, 1) for x in (scaled, actions, log_chances, advantage, advantage + values)]
            divergence = update(policy, self.optimizer, *flat, self.s)
            policy.learn_scales(raw)
            much = divergence / self.s.divergence
            group["lr"] = min(max(group["lr"] * (1.3 if much < 1 / 1.5 else 1 / 1.3 if much > 1.5 else 1), 1e-5), 3e-3)
            self.updates, self.processor_s = self.updates + 1, time.process_time() - started_s
            yield {"update": self.updates, "periods": self.updates * rewards.numel(), "processor_s": self.processor_s,
                   "episode": statistics.mean(returns) if returns else math.nan,
                   "per_s": rewards.mean().item() / envs.period_s, "divergence": divergence, "rate": group["lr"],
                   "deviation": policy.log_deviation.exp().mean().item()}


def learn(args):
    s, path = dataclasses.replace(Settings(), worlds=args.worlds), args.out / "policy.pt"
    envs = taut.gym.make_vec(str(TASK), s.worlds, threads=0, autoreset_mode=taut.gym.AutoresetMode.SAME_STEP)
    learner = Learner(envs, args.seed, s)
    args.out.mkdir(parents=True, exist_ok=True)
    if path.exists():
        learner.load(path)
        print(f"{path}: goes on after update {learner.updates}")
        if 0 < args.updates <= learner.updates:
            return
    stop, ends_s = [], time.monotonic() + 60 * args.minutes
    for number in signal.SIGINT, signal.SIGTERM:
        signal.signal(number, lambda *_: stop.append(True))
    for said in learner.learn(envs):
        over = stop or time.monotonic() >= ends_s or args.updates and learner.updates >= args.updates
        if over or learner.updates % 10 == 0:
            print("update {update}: {periods} periods, {processor_s:.0f} s of processor, {per_s:.2f} m/s, episodes "
                  "{episode:.2f} m, deviation {deviation:.2f}, rate {rate:.1e}".format(**said), flush=True)
            learner.save(path)
            with open(args.out / "curve.csv", "a", newline="") as file:
                csv.writer(file).writerows([said.values()] if file.tell() else [said, said.values()])
        if over:
            return print(f"saved to {path}; --play shows what it can do")


def play(args):
    import ppo_play
    learner = Learner(taut.gym.make_vec(str(TASK)), args.seed, Settings())
    learner.load(args.out / "policy.pt", same=["channels"])
    print(f"after {learner.updates} updates")
    ppo_play.beside_the_sine(learner.policy, TASK, args.out / "play", args.seconds, args.starts)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default, text in (
            ("minutes", 10.0, "learn for so long"), ("updates", 0, "or until there are so many; 0: as many as it gets"),
            ("seed", 1, "of all that is drawn"), ("worlds", Settings.worlds, "side by side, to learn from"),
            ("out", pathlib.Path("runs/ppo"), "folder of policy and curve"),
            ("seconds", 60.0, "with --play: of each run"), ("starts", 12, "with --play: how many")):
        parser.add_argument(f"--{name}", type=type(default), default=default, help=f"{text} ({default})")
    parser.add_argument("--play", action="store_true", help="show what was learned, beside the sine")
    args = parser.parse_args()
    for names, good, what in ((("minutes", "worlds", "seconds", "starts"), lambda x: 0 < x < math.inf, "more than 0"),
                              (("updates", "seed"), lambda x: x >= 0, "0 or more")):
        for name in names:
            if not good(getattr(args, name)):
                parser.error(f"--{name} {getattr(args, name)}: {what}")
    torch.set_num_threads(1)  # sums depend on the number of threads
    torch.use_deterministic_algorithms(True)
    try:
        (play if args.play else learn)(args)
    except (OSError, taut.InputError) as error:  # such as an unwritable folder or an invalid duration
        print(error, file=sys.stderr)
        sys.exit(3)


if __name__ == "__main__":
    main()
