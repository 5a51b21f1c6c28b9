"""Random actions in a vectorized environment: mean return of 64 spines over two seconds."""

import numpy as np

import taut.gym

envs = taut.gym.make_vec("experiments/learn_spine.yaml", num_envs=64, threads=2)
print(f"{len(envs.observation_channels)} observations from {envs.observation_channels[0]} on,")
print(f"{len(envs.action_channels)} actions: 1 is {envs.action_scales[0]} of {envs.action_channels[0]}")

random, worth = np.random.default_rng(0), np.zeros(64)
observations, _ = envs.reset(seed=0)
for _ in range(round(2 / envs.period_s)):
    actions = random.uniform(-1, 1, envs.action_space.shape)
    observations, rewards, terminated, truncated, infos = envs.step(actions)
    worth += rewards
print(f"worth {worth.mean():.4f} in the mean, {worth.min():.4f} to {worth.max():.4f}")
