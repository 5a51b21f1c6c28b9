"""Replacements for the parts of Gymnasium that taut.gym uses, for machines without Gymnasium."""

import enum

import numpy as np


class AutoresetMode(enum.Enum):
    """Time at which a world starts its next episode after the end of one."""

    NEXT_STEP = "NextStep"
    SAME_STEP = "SameStep"
    DISABLED = "Disabled"


class Box:
    """Space of numbers between bounds: the commonly used part of Gymnasium's Box."""

    def __init__(self, low, high, shape=None, dtype=np.float32, seed=None):
        self.shape = tuple(shape) if shape is not None else np.shape(low)
        self.dtype = np.dtype(dtype)
        self.low = np.full(self.shape, low, self.dtype) if np.ndim(low) == 0 else np.asarray(low, self.dtype)
        self.high = np.full(self.shape, high, self.dtype) if np.ndim(high) == 0 else np.asarray(high, self.dtype)
        self._random = np.random.default_rng(seed)

    def seed(self, seed=None):
        self._random = np.random.default_rng(seed)

    def contains(self, x):
        x = np.asarray(x)
        return bool(x.shape == self.shape and (x >= self.low).all() and (x <= self.high).all())

    def sample(self):
        """Returns a random sample: uniform between finite bounds, normal without bounds."""
        bounded = np.isfinite(self.low) & np.isfinite(self.high)
        low, high = np.where(bounded, self.low, 0.0), np.where(bounded, self.high, 1.0)
        drawn = np.where(bounded, self._random.uniform(low, high), self._random.normal(size=self.shape))
        return drawn.astype(self.dtype)

    def __eq__(self, other):
        return (isinstance(other, Box) and self.shape == other.shape and self.dtype == other.dtype
                and (self.low == other.low).all() and (self.high == other.high).all())

    def __repr__(self):
        return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"


def batch_space(space, n):
    return Box(np.tile(space.low, (n, 1)), np.tile(space.high, (n, 1)), dtype=space.dtype)
