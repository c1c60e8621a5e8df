"""Cubic Hermite splines through few keys, fitted to many frames: the curves of F-curves with Bezier handles.

A Bezier segment whose handles lie at one third and two thirds of it in time is a cubic polynomial of time:
the Hermite cubic with the values and slopes of its two keys (Farin 2002, *Curves and Surfaces for CAGD*,
section 7.5). The handles' heights are then `value + slope * length / 3` and `value - slope * length / 3`.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from ..arrays import Array, IndexArray
from ..numerics.cubic import hermite_basis

BAND = 3  # bandwidth: value and slope of a key couple with those of the next
SLOPE_WEIGHT = 0.0025
"""Weight of the data's slope at a key [frames²]: it decides where no frame lies between keys."""


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
        v0, m0, v1, m1 = _basis(times, self.keys[:-1], self.keys[1:], frames, piece).T[..., None]
        values, slopes = self.values, self.slopes
        return np.asarray(
            v0 * values[piece] + m0 * slopes[piece] + v1 * values[piece + 1] + m1 * slopes[piece + 1]
        )

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
    band[BAND, 1::2] += SLOPE_WEIGHT
    right[1::2] += SLOPE_WEIGHT * _slopes(times, data, keys)
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
    _, solved, failed = scipy.linalg.lapack.dpbsv(band, right)
    if failed:
        raise np.linalg.LinAlgError("the keys' values and slopes are not determined by the frames")
    values, slopes = spline.values.copy(), spline.slopes.copy()
    values[low : high + 1], slopes[low : high + 1] = solved[0::2], solved[1::2]
    return Spline(spline.keys, values, slopes)


def without_each(
    times: Array, data: Array, spline: Spline, inner: IndexArray, exact: IndexArray, reach: int
) -> tuple[IndexArray, IndexArray, Array]:
    """Curves without one key each, and the `reach` keys on either side of it fitted anew as by `refit`.

    `inner` (T,) are the keys left out, with more than `reach` keys on both sides. The frames (N,) that
    change, trial after trial, where each trial's begin (T,), and the curves' values (N, C) there.
    """
    around = np.arange(-reach - 1, reach + 2)
    window = inner[:, None] + around[around != 0]  # (T, W) keys of each trial, the outer ones as they are
    keys = spline.keys[window]
    trials, width = keys.shape
    rows = 2 * width
    own, merged = (
        _pieces(times, data, starts, ends)
        for starts, ends in (
            (spline.keys[:-1], spline.keys[1:]),
            (spline.keys[inner - 1], spline.keys[inner + 1]),
        )
    )
    matrix = np.zeros((trials, rows, rows))
    right = np.zeros((trials, rows, data.shape[1]))
    for number in range(width - 1):
        at = slice(2 * number, 2 * number + 4)
        squares, products = merged if number == reach else [each[window[:, number]] for each in own]
        matrix[:, at, at] += squares
        right[:, at] += products
    matrix[:, range(1, rows, 2), range(1, rows, 2)] += SLOPE_WEIGHT
    right[:, 1::2] += SLOPE_WEIGHT * _slopes(times, data, keys)
    pinned = np.isin(keys, exact)
    fixed = np.zeros((trials, rows), dtype=bool)
    fixed[:, 0::2] = pinned
    fixed[:, [0, 1, -2, -1]] = True
    values = np.zeros_like(right)
    values[:, 0::2] = np.where(pinned[..., None], data[keys], spline.values[window])
    values[:, 1::2] = spline.slopes[window]
    values[~fixed] = 0.0
    right -= matrix @ values
    right[fixed] = values[fixed]
    matrix[fixed[:, :, None] | fixed[:, None, :]] = 0.0
    matrix[:, range(rows), range(rows)] += fixed
    solved = np.linalg.solve(matrix, right).reshape(trials, width, 2, -1)
    earlier, later = (each.reshape(-1, 2, solved.shape[-1]) for each in (solved[:, :-1], solved[:, 1:]))
    starts, ends = keys[:, :-1].ravel(), keys[:, 1:].ravel()
    lengths = ends - starts
    lengths[width - 2 :: width - 1] += 1  # the last piece of a trial has its end as well
    frame, piece = _ranges(starts, lengths)
    v0, m0, v1, m1 = _basis(times, starts, ends, frame, piece).T[..., None]
    shown = v0 * earlier[piece, 0] + m0 * earlier[piece, 1] + v1 * later[piece, 0] + m1 * later[piece, 1]
    counts = keys[:, -1] - keys[:, 0] + 1
    return frame, np.cumsum(counts) - counts, np.asarray(shown)


def _slopes(times: Array, data: Array, keys: IndexArray) -> Array:
    """(..., C) the data's slopes at keys (...)."""
    before, after = np.maximum(keys - 1, 0), np.minimum(keys + 1, len(times) - 1)
    return np.asarray((data[after] - data[before]) / (times[after] - times[before])[..., None])


def _normal_equations(times: Array, data: Array, keys: IndexArray) -> tuple[Array, Array]:
    """Normal equations of the frames from the first to the last of K keys, values and slopes in turn.

    The matrix as upper bands (BAND + 1, 2 K), and the right-hand side (2 K, C).
    """
    pieces = len(keys) - 1
    squares, products = _pieces(times, data, keys[:-1], keys[1:])
    squares[-1, 2, 2] += 1.0  # the last piece has its end as well
    products[-1, 2] += data[keys[-1]]
    band = np.zeros((BAND + 1, 2 * len(keys)))
    right = np.zeros((2 * len(keys), data.shape[1]))
    for i in range(BAND + 1):
        right[i : i + 2 * pieces : 2] += products[:, i]
        for j in range(i, BAND + 1):
            band[BAND - (j - i), j : j + 2 * pieces : 2] += squares[:, i, j]
    return band, right


def _pieces(times: Array, data: Array, starts: IndexArray, ends: IndexArray) -> tuple[Array, Array]:
    """Normal equations (pieces, 4, 4) and (pieces, 4, C) of pieces from frames up to before others."""
    lengths = ends - starts
    frame, piece = _ranges(starts, lengths)
    basis, first = _basis(times, starts, ends, frame, piece), np.cumsum(lengths) - lengths
    squares = np.add.reduceat(basis[:, :, None] * basis[:, None, :], first)
    return squares, np.add.reduceat(basis[:, :, None] * data[frame, None, :], first)


def _ranges(starts: IndexArray, lengths: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Frames that follow some starts, one range after another, and the range that each is of."""
    piece = np.repeat(np.arange(len(starts)), lengths)
    return np.arange(len(piece)) + (starts - np.cumsum(lengths) + lengths)[piece], piece


def _basis(times: Array, starts: IndexArray, ends: IndexArray, frame: IndexArray, piece: IndexArray) -> Array:
    """(N, 4) Hermite basis: factors of the earlier key's value and slope and of the later one's."""
    begun = times[starts]
    length = (times[ends] - begun)[piece]
    return hermite_basis(length, (times[frame] - begun[piece]) / length)
