"""Environments for reinforcement learning with Gymnasium's interface, which does not require Gymnasium.

    envs = taut.gym.make_vec("experiments/learn_spine.yaml", num_envs=256, threads=0)
    observations, infos = envs.reset(seed=1)
    observations, rewards, terminated, truncated, infos = envs.step(actions)

If gymnasium is installed (0.29 or newer), the classes derive from its VectorEnv and Env and use its spaces; else they
have the same methods and attributes. `AutoresetMode` is Gymnasium's class from version 1.1, otherwise an enum with the
same members.
The experiment's `environment` defines actions, observations and rewards (docs/environments.md). For the same seed and
actions a world is bit-identical, independent of all other worlds.
"""

import enum as _enum
import numbers as _numbers
import os as _os
import re as _re
from typing import Any as _Any

import numpy as _np

from taut import _core

_VectorBase: _Any = object
_EnvBase: _Any = object
try:
    import gymnasium as _gymnasium
except ModuleNotFoundError as _error:
    if _error.name != "gymnasium":  # an installed module that cannot be imported
        raise
    from taut._spaces import AutoresetMode, Box, batch_space as _batch_space
else:
    if tuple(map(int, _re.findall(r"\d+", _gymnasium.__version__)[:2])) < (0, 29):
        raise ImportError(f"gymnasium {_gymnasium.__version__} is installed; taut.gym needs 0.29 or newer, or none")
    import gymnasium.vector as _vector
    from gymnasium.spaces import Box  # type: ignore[no-redef]
    from gymnasium.vector.utils import batch_space as _batch_space  # type: ignore[no-redef]

    _VectorBase, _EnvBase = _vector.VectorEnv, _gymnasium.Env
    try:
        from gymnasium.vector import AutoresetMode  # type: ignore[no-redef]
    except ImportError:  # before 1.1
        from taut._spaces import AutoresetMode

EpisodeEnd = _enum.IntEnum(  # type: ignore[misc]
    "EpisodeEnd", [(name.upper(), value) for name, value in _core.episode_ends])
EpisodeEnd.__doc__ = "Reason why an episode ended; NONE and TIME are no failures. See docs/environments.md."

_AUTORESET = {AutoresetMode.NEXT_STEP: "next_step", AutoresetMode.SAME_STEP: "same_step",
              AutoresetMode.DISABLED: "disabled"}


def _experiment(experiment, set_):
    if isinstance(experiment, _core.Experiment):
        if set_:
            raise ValueError("set: supported only for an experiment given as a path")
        return experiment
    if not isinstance(experiment, (str, _os.PathLike)):
        raise TypeError(f"experiment: {experiment!r}; expected an Experiment or the path of an experiment file")
    loaded = _core.load(_os.fspath(experiment), **(set_ or {}))
    if not isinstance(loaded, _core.Experiment):
        raise ValueError(f"{experiment}: a model; expected an experiment")
    return loaded


def _seed(seed, worlds=1):
    """Returns `seed` if it and the next `worlds` - 1 integers are valid seeds; else raises ValueError."""
    below = 2**64 - worlds + 1
    whole = isinstance(seed, _numbers.Integral) and not isinstance(seed, bool)
    if not whole or not 0 <= int(seed) < below:
        raise ValueError(f"seed: {seed!r}; expected a whole number, 0 or more, below {below}")
    return int(seed)


def _flag(value, name):
    """Returns a bool; raises TypeError for other values, because their truth value is rarely intended."""
    if not isinstance(value, (bool, _np.bool_)):
        raise TypeError(f"{name}: {value!r}; expected True or False")
    return bool(value)


def _mask(mask, worlds):
    """Returns a mask of worlds as bytes; raises ValueError unless it is an array (worlds,) of bools, 0 and 1."""
    array = _np.asarray(mask)
    if array.shape != (worlds,) or array.dtype.kind not in "biu" or not _np.isin(array, (0, 1)).all():
        raise ValueError(f"reset_mask: {mask!r}; expected {worlds} bools")
    return _np.ascontiguousarray(array.astype(_np.uint8))


def _real(actions):
    """Returns `actions` as an array of real numbers without masked entries; else raises ValueError."""
    array = _np.asanyarray(actions)
    masked = _np.ma.is_masked(array)
    if masked or array.dtype.kind not in "biufO":
        raise ValueError(f"actions: {'masked entries' if masked else array.dtype}; expected real numbers")
    return array


class VectorEnv(_VectorBase):
    """Many worlds with one episode each. Arrays have the shape (num_envs, n); actions are from -1 to 1.

    `copy=False`: `step` and `reset` return the same arrays every time, which saves allocations.
    Callbacks receive all worlds at once: `observe(rows, observations)` fills the last `own_observations` columns;
    `judge(rows, observations, actions, rewards, terminated)` changes the last two. The arrays are copies that
    callbacks may keep; changes after the return have no effect. Ignore rows of worlds whose `rows` is 0.
    Callbacks may call `time_s`, `hash` and `experiment`; calls that change the environment raise RuntimeError there.
    Thread-safe: calls from several threads wait for each other.
    """

    is_vector_env = True  # required by Gymnasium before 1.0
    render_mode = None
    spec = None

    def __init__(self, experiment, num_envs=1, *, threads=1, simd=None, dtype=_np.float32, copy=True,
                 autoreset_mode=AutoresetMode.NEXT_STEP, randomise=True, seed=None, set=None,
                 own_observations=0, observe=None, judge=None):
        dtype = _np.dtype(dtype)
        if dtype not in (_np.float32, _np.float64):
            raise ValueError(f"dtype: {dtype}; expected float32 or float64")
        if not isinstance(autoreset_mode, AutoresetMode):
            autoreset_mode = AutoresetMode(autoreset_mode)
        copy = _flag(copy, "copy")
        if seed is not None:
            seed = _seed(seed, max(num_envs, 1))
        self._core = _core.Environments(
            _experiment(experiment, set), num_envs, threads, simd, _AUTORESET[autoreset_mode], randomise, seed,
            own_observations, observe, judge)
        self.num_envs = num_envs
        self.metadata = {"autoreset_mode": autoreset_mode, "render_modes": []}
        self.closed = False
        self._dtype, self._copy, self._mode = dtype, copy, autoreset_mode
        self._reset = self._core.reset_f32 if dtype == _np.float32 else self._core.reset_f64
        self._step = self._core.step_f32 if dtype == _np.float32 else self._core.step_f64
        actions, seen = len(self.action_channels), len(self.observation_channels)
        self.single_action_space = Box(-1.0, 1.0, (actions,), dtype)
        self.single_observation_space = Box(-_np.inf, _np.inf, (seen,), dtype)
        self.action_space = _batch_space(self.single_action_space, num_envs)
        self.observation_space = _batch_space(self.single_observation_space, num_envs)
        self._observations = _np.zeros((num_envs, seen), dtype)
        self._final = _np.zeros((num_envs, seen), dtype) if self._mode is AutoresetMode.SAME_STEP else None
        self._rewards = _np.zeros(num_envs)
        self._terminated = _np.zeros(num_envs, _np.uint8)
        self._truncated = _np.zeros(num_envs, _np.uint8)

    @property
    def action_channels(self):
        """Names of the actions' channels, which end with the unit: cable/NAME/rest_length_m."""
        return self._core.action_channels

    @property
    def action_scales(self):
        """Change of the channel's quantity for an action of 1, per action, in its unit."""
        return self._core.action_scales

    @property
    def observation_channels(self):
        """Names of the observations: trace channels, then own/0, own/1 ..."""
        return self._core.observation_channels

    @property
    def period_s(self):
        """Time between actions [s]."""
        return self._core.period_s

    @property
    def episode_steps(self):
        """Number of steps after which an episode is truncated."""
        return self._core.episode_steps

    def reset(self, *, seed=None, options=None):
        """Starts new episodes in all worlds, or in the worlds of `options={"reset_mask": bool[num_envs]}`. World i gets
        the seed seed + i, or seed[i]; None: each world derives a new seed from its last one. Returns
        observations and infos."""
        self._open()
        options = dict(options or {})
        mask = options.pop("reset_mask", None)
        if options:
            raise ValueError(f"options: unknown {', '.join(sorted(options))}; expected only reset_mask")
        seeds = None
        if seed is not None:
            if _np.ndim(seed) == 0:
                seeds = _np.uint64(_seed(seed, self.num_envs)) + _np.arange(self.num_envs, dtype=_np.uint64)
            else:
                seeds = _np.array([_seed(one) for one in seed], dtype=_np.uint64)
        if mask is not None:
            mask = _mask(mask, self.num_envs)
        observations = self._fresh(self._observations)
        self._reset(seeds, mask, observations)
        self._observations = observations
        return observations, {}

    def step(self, actions):
        """Advances all worlds by one period: returns observations, rewards, terminated, truncated, infos."""
        self._open()
        actions = _np.ascontiguousarray(_real(actions), dtype=self._dtype)
        observations, rewards = self._new(self._observations), self._new(self._rewards)
        final = self._fresh(self._final) if self._final is not None else None
        self._step(actions, observations, rewards, self._terminated, self._truncated, final)
        self._observations = observations
        over, cut = self._terminated.view(bool), self._truncated.view(bool)
        if self._copy:
            over, cut = over.copy(), cut.copy()
        return observations, rewards, over, cut, self._infos(over, cut, final)

    def _infos(self, over, cut, final):
        ended = over | cut
        if not ended.any():
            return {}
        _, steps, returns, ends = self._core.episodes(self._mode is AutoresetMode.SAME_STEP)
        of_episode = {"end": ends, "_end": ended, "episode_return": returns, "_episode_return": ended,
                      "episode_steps": steps, "_episode_steps": ended}
        if final is None:
            return of_episode
        return {"final_obs": final, "_final_obs": ended, "final_info": of_episode, "_final_info": ended}

    def experiment(self, world):
        """Returns the present episode of a world as an experiment: `taut.run` of it is bit-identical, without
        actions."""
        return self._core.experiment(world)

    def hash(self, world=0):
        """Returns a hash of a world's state."""
        return self._core.hash(world)

    def time_s(self, world=0):
        """Returns the time of a world's episode [s]."""
        return self._core.time_s(world)

    def save(self, world=0):
        """Returns a world and its episode as bytes, for searches that try several futures from one state."""
        self._open()
        return self._core.save(world)

    def restore(self, snapshot, world=0):
        """Restores the result of `save`, bit-identically, into any world of environments of the same experiment and
        options. Raises `taut.InputError` for other bytes."""
        self._open()
        self._core.restore(snapshot, world)

    def render(self):
        raise NotImplementedError("rendering is not supported: run `experiment(world)` and open the run with `taut view`")

    def close(self, **kwargs):
        self.closed = True

    def _open(self):
        if self.closed:
            raise RuntimeError("these environments are closed")

    def _fresh(self, array):
        return array.copy() if self._copy else array

    def _new(self, array):  # every element will be written
        return _np.empty_like(array) if self._copy else array


class Env(_EnvBase):
    """One world, as a gymnasium.Env. For training use `make_vec`, which is many times as fast."""

    metadata: dict = {"render_modes": []}
    render_mode = None
    spec = None

    def __init__(self, experiment, **how):
        how["autoreset_mode"] = AutoresetMode.DISABLED
        self._one = VectorEnv(experiment, 1, **how)
        self.action_space = self._one.single_action_space
        self.observation_space = self._one.single_observation_space

    def reset(self, *, seed=None, options=None):
        """Starts a new episode: returns observation and infos."""
        if _EnvBase is not object:
            super().reset(seed=seed)
        if options:
            raise ValueError(f"options: unknown {', '.join(sorted(options))}")
        observations, _ = self._one.reset(seed=seed)
        return observations[0], {}

    def step(self, action):
        """Advances by one period: returns observation, reward, terminated, truncated, infos."""
        observations, rewards, over, cut, infos = self._one.step(_np.asanyarray(action)[None])
        infos = {key: value[0] for key, value in infos.items() if not key.startswith("_")}
        return observations[0], float(rewards[0]), bool(over[0]), bool(cut[0]), infos

    def experiment(self):
        """Returns the present episode as an experiment."""
        return self._one.experiment(0)

    def hash(self):
        """Returns a hash of the state."""
        return self._one.hash(0)

    def save(self):
        """Returns the world and its episode as bytes."""
        return self._one.save(0)

    def restore(self, snapshot):
        """Restores the result of `save`, in environments of the same experiment and options."""
        self._one.restore(snapshot, 0)

    def render(self):
        return self._one.render()

    def close(self):
        self._one.close()


def make_vec(experiment, num_envs=1, **how):
    """Creates a `VectorEnv` of an experiment, given by path or as the result of `taut.load`; for the arguments see
    `VectorEnv`."""
    return VectorEnv(experiment, num_envs, **how)
