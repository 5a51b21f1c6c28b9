"""Steps 32 worlds with random actions for one episode."""

import numpy as np

import taut.gym

envs = taut.gym.make_vec("train.yaml", num_envs=32, threads=0)
random, returns = np.random.default_rng(0), np.zeros(envs.num_envs)
observations, _ = envs.reset(seed=0)
for _ in range(60):
    actions = random.uniform(-1, 1, envs.action_space.shape)
    observations, rewards, terminated, truncated, infos = envs.step(actions)
    returns += rewards
print(f"observations {observations.shape}, actions {actions.shape}, ended: {np.sum(terminated | truncated)}")
print(f"distance along x: {returns.mean():.2f} m in the mean, {returns.max():.2f} m at most")
