"""Smooth paths out of values whose errors wander: what was seen is path + wander + grain.

The path has second differences of one usual size, the wander keeps a part of itself from frame to frame
(AR(1), an Ornstein-Uhlenbeck process), the grain is new in every frame, with heavy tails. How the three
sizes relate is learned from the values themselves by marginal likelihood, so that slow motions are smoothed
more than fast ones.
Rasmussen & Williams (2006), *Gaussian Processes for Machine Learning*, ch. 5; the systems are banded.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from .block_banded import BlockBanded
from .robust import DEGREES, student_weight

CONSTANT_SHARE = 0.3  # of the wander's variance that never changes, which only exact values can tell
BENDS = tuple(10.0 ** (0.25 * step) for step in range(-6, 4))
"""Sizes of the path's second differences at `USUAL_RATE` that are tried, in sizes of the wander."""
USUAL_RATE = 30.0
MOST_LEARNED = 2000  # frames that the sizes are learned from
EXACT = 1e-3  # standard deviation of an exact value, in sizes of the wander
NO_FRAMES, NO_VALUES = np.zeros(0, dtype=np.intp), np.zeros((0, 3))


@dataclass(frozen=True)
class Sizes:
    """Sizes of what values consist of, in those of their wander, and the rate they belong to."""

    bend: float  # usual size of a second difference of the path, frame by frame
    grain: float
    rate: float  # frames a second


class _System:
    """The equations of path and wander of F frames, and their factor."""

    def __init__(self, sizes: Sizes, weight: Array, exact: IndexArray) -> None:
        frames = len(weight)
        # A network's error forgets itself in 0.4 s; 0.3 to 0.6 give the same within 1 %.
        keep = np.exp(-1.0 / (sizes.rate * 0.4))
        fresh = 1.0 - keep**2
        self.precision = weight / sizes.grain**2  # (F,) of what was seen
        matrix = BlockBanded(frames, 2)
        matrix.add_combination(slice(0, 1), (1.0, -2.0, 1.0), np.array(sizes.bend**-2))
        matrix.add_combination(slice(1, 2), (-keep, 1.0), np.array(1.0 / fresh))
        matrix.diagonal += self.precision[:, None, None]
        matrix.diagonal[0, 1, 1] += 1.0
        matrix.diagonal[exact, 0, 0] += EXACT**-2
        self.factor = matrix.factorize()
        # Logarithm of the determinant of what is believed beforehand of path and wander.
        self.prior = -(frames - 1) * np.log(fresh) - 2.0 * (frames - 2) * np.log(sizes.bend)

    def solve(self, values: Array, exact: IndexArray, known: Array) -> tuple[Array, Array]:
        """Path and wander (F, C) of values (F, C) and exact ones (K, C)."""
        right = np.repeat((self.precision[:, None] * values)[:, None], 2, axis=1)
        right[exact, 0] += EXACT**-2 * known
        found = self.factor.solve(right)
        return found[:, 0], found[:, 1]


def learn_sizes(values: Array, rate: float) -> Sizes:
    """Learn the sizes from values (F, N, 3) of N points of one body; frames with NaN are left out.

    Each point has an error of its own size; what is learned is how path, wander and grain relate.
    """
    middle = values[max(0, (len(values) - MOST_LEARNED) // 2) :][:MOST_LEARNED]
    seen = np.isfinite(middle).all(axis=(1, 2))
    filled = np.where(seen[:, None, None], middle, 0.0).reshape(len(middle), -1)
    usual = (USUAL_RATE / rate) ** 1.5  # of the second difference of a path bent by independent pushes
    tried = [Sizes(bend * usual, grain, rate) for grain in (0.2, 0.4, 0.8) for bend in BENDS]
    return min(tried, key=lambda sizes: _misfit(sizes, filled, seen))


def _misfit(sizes: Sizes, values: Array, seen: BoolArray) -> float:
    """Negative logarithm of the marginal likelihood of values (F, 3 N), up to a constant."""
    system = _System(sizes, seen.astype(np.float64), NO_FRAMES)
    path, wander = system.solve(values, NO_FRAMES, np.zeros((0, values.shape[1])))
    squared = values * system.precision[:, None] * (values - path - wander)
    count = 3 * (int(seen.sum()) - 2)
    sizes_squared = squared.reshape(len(values), -1, 3).sum(axis=(0, 2)) / max(count, 1)
    points = values.shape[1] // 3
    determinant = (
        2.0 * np.log(system.factor.lower[0]).sum() - system.prior - np.log(system.precision[seen]).sum()
    )
    return float(0.5 * count * np.log(np.maximum(sizes_squared, 1e-18)).sum() + 1.5 * points * determinant)


def smooth_path(
    values: Array, sizes: Sizes, frames: IndexArray = NO_FRAMES, known: Array = NO_VALUES
) -> Array:
    """The path (F, 3) of one point's values (F, 3), where NaN is not seen.

    At exact `frames` the path is `known` (K, 3), and values there do not count; the error beside them is
    then known too and wanders away from what it is there.
    """
    seen = np.isfinite(values).all(axis=1)
    seen[frames] = False
    filled = np.where(seen[:, None], values, 0.0)
    weight = seen.astype(np.float64)
    path = filled
    for _ in range(4):
        system = _System(sizes, weight, frames)
        path, wander = system.solve(filled, frames, known)
        residual = filled - path - wander
        if len(frames):
            ones = np.ones((len(values), 1))
            flat, drift = system.solve(ones, frames, np.zeros((len(frames), 1)))
            told = system.precision @ (ones - flat - drift)[:, 0]
            constant = system.precision @ residual / (told + (1.0 - CONSTANT_SHARE) / CONSTANT_SHARE)
            path = path - constant * flat
            residual = residual - constant * (ones - flat - drift)
        squared = (residual**2).sum(axis=1)
        size = np.median(squared[seen]) / 2.37 if seen.any() else 0.0  # median of a squared normal of three
        weight = seen * student_weight(squared / max(size, 1e-18), DEGREES, 3)
    return path
