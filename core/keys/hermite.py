"""Cubic Hermite splines through few keys, fitted to many frames: the curves of F-curves with Bezier handles.

A Bezier segment whose handles lie at one third and two thirds of it in time is a cubic polynomial of time:
the Hermite cubic with the values and slopes of its two keys (Farin 2002, *Curves and Surfaces for CAGD*,
section 7.5). The handles' heights are then `value + slope * length / 3` and `value - slope * length / 3`.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.linalg.lapack import dpbsv

from ..arrays import Array, IndexArray

BAND = 3  # bandwidth: value and slope of a key couple with those of the next


@dataclass(frozen=True, eq=False)
class Spline:
    """K keys of C curves that share their frames."""

    keys: IndexArray  # (K,) increasing frame indices of the keys
    values: Array  # (K, C)
    slopes: Array  # (K, C) per unit of time, the same on both sides of a key

    def evaluate(self, times: Array, first: int, last: int) -> Array:
        """Values (N, C) at the frames `first` to `last`, both included, which lie between the outer keys."""
        frames = np.arange(first, last + 1)
        piece = np.clip(np.searchsorted(self.keys, frames, side="right") - 1, 0, len(self.keys) - 2)
        v0, m0, v1, m1 = _basis(times, self.keys, frames, piece).T[..., None]
        values, slopes = self.values, self.slopes
        return np.asarray(
            v0 * values[piece] + m0 * slopes[piece] + v1 * values[piece + 1] + m1 * slopes[piece + 1]
        )

    def with_keys(self, times: Array, new: IndexArray) -> "Spline":
        """The spline with further keys on its own curve (between its outer keys): nothing moves yet."""
        fresh = np.setdiff1d(new, self.keys).astype(np.intp)
        curve = CubicHermiteSpline(times[self.keys], self.values, self.slopes)
        keys = np.concatenate([self.keys, fresh])
        order = np.argsort(keys, kind="stable")
        values = np.concatenate([self.values, curve(times[fresh])])
        slopes = np.concatenate([self.slopes, curve(times[fresh], 1)])
        return Spline(keys[order], values[order], slopes[order])

    def without_key(self, position: int) -> "Spline":
        """The spline without one of its inner keys."""
        return Spline(
            np.delete(self.keys, position),
            np.delete(self.values, position, axis=0),
            np.delete(self.slopes, position, axis=0),
        )


def values_of(held: Array | Spline) -> Array:
    """(K, C) values of keys, or of every frame."""
    return held.values if isinstance(held, Spline) else held


def fit_keys(times: Array, data: Array, keys: IndexArray, exact: IndexArray) -> Spline:
    """The spline with given keys that is nearest to data (F, C) in the sense of least squares.

    `keys` are at least two rising frames, the first and the last among them; at the frames `exact` a key has
    the data's own value.
    """
    return refit(times, data, Spline(keys, data[keys], data[keys]), 0, len(keys) - 1, exact)


def refit(times: Array, data: Array, spline: Spline, first: int, last: int, exact: IndexArray) -> Spline:
    """Fit the keys `first` to `last` (counted among the keys, both included) anew; all others stay."""
    low, high = max(first - 1, 0), min(last + 1, len(spline.keys) - 1)
    keys = spline.keys[low : high + 1]
    band, right = _normal_equations(times, data, keys)
    # The data's slope at a key has a little weight [frames²]: it decides where no frame lies between keys.
    before, after = np.maximum(keys - 1, 0), np.minimum(keys + 1, len(times) - 1)
    slope = (data[after] - data[before]) / (times[after] - times[before])[:, None]
    band[BAND, 1::2] += 0.0025
    right[1::2] += 0.0025 * slope
    pinned = np.searchsorted(exact, keys, "right") > np.searchsorted(exact, keys)
    values = np.zeros_like(right)  # the known ones, and zero for those that are sought
    values[0::2] = np.where(pinned[:, None], data[keys], spline.values[low : high + 1])
    values[1::2] = spline.slopes[low : high + 1]
    fixed = np.zeros(len(right), dtype=bool)
    fixed[0::2] = pinned
    fixed[: 2 * (first - low)] = True
    fixed[len(right) - 2 * (high - last) :] = True
    values[~fixed] = 0.0
    for apart in range(1, BAND + 1):
        row = band[BAND - apart, apart:]
        right[:-apart] -= row[:, None] * values[apart:]
        right[apart:] -= row[:, None] * values[:-apart]
        row[fixed[apart:] | fixed[:-apart]] = 0.0
    band[BAND, fixed] = 1.0
    right[fixed] = values[fixed]
    # A fit is solved thousands of times: the plain LAPACK call costs a tenth of `solveh_banded`.
    _, solved, failed = dpbsv(band, right)
    if failed:
        raise np.linalg.LinAlgError("the keys' values and slopes are not determined by the frames")
    values, slopes = spline.values.copy(), spline.slopes.copy()
    values[low : high + 1], slopes[low : high + 1] = solved[0::2], solved[1::2]
    return Spline(spline.keys, values, slopes)


def _normal_equations(times: Array, data: Array, keys: IndexArray) -> tuple[Array, Array]:
    """Normal equations of the frames from the first to the last of K keys, values and slopes in turn.

    The matrix as upper bands (BAND + 1, 2 K), and the right-hand side (2 K, C).
    """
    pieces = len(keys) - 1
    lengths = np.diff(keys)
    lengths[-1] += 1  # the last piece has its end as well
    frame = np.arange(keys[0], keys[-1] + 1)
    basis = _basis(times, keys, frame, np.repeat(np.arange(pieces), lengths))
    starts = keys[:-1] - keys[0]
    squares = np.add.reduceat(basis[:, :, None] * basis[:, None, :], starts)  # (pieces, 4, 4)
    products = np.add.reduceat(basis[:, :, None] * data[frame, None, :], starts)  # (pieces, 4, C)
    band = np.zeros((BAND + 1, 2 * len(keys)))
    right = np.zeros((2 * len(keys), data.shape[1]))
    for i in range(BAND + 1):
        right[i : i + 2 * pieces : 2] += products[:, i]
        for j in range(i, BAND + 1):
            band[BAND - (j - i), j : j + 2 * pieces : 2] += squares[:, i, j]
    return band, right


def _basis(times: Array, keys: IndexArray, frame: IndexArray, piece: IndexArray) -> Array:
    """(N, 4) Hermite basis: factors of the earlier key's value and slope and of the later one's."""
    at = times[keys]
    start, length = at[piece], np.diff(at)[piece]
    s = (times[frame] - start) / length
    rest = 1.0 - s
    basis = np.empty((len(frame), 4))
    basis[:, 0] = rest * rest * (1.0 + 2.0 * s)
    basis[:, 1] = rest * rest * s * length
    basis[:, 2] = s * s * (3.0 - 2.0 * s)
    basis[:, 3] = -s * s * rest * length
    return basis
