"""Directions in space, and signals over time."""

import numpy as np

from ..arrays import Array, BoolArray, IndexArray


def unit(vectors: Array) -> Array:
    """Vectors (..., N) made one long; those without a direction stay short."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, 1e-12))


def across(vector: Array) -> Array:
    """Some unit vector (3,) at right angles to a vector (3,)."""
    return unit(np.cross(vector, np.eye(3)[np.argmin(np.abs(vector))]))


def usual_step(time_s: Array) -> float:
    """Median step of times (F,) that advances [s]; 1 where none does."""
    step = np.diff(time_s)
    advancing = step[np.isfinite(step) & (step > 0.0)]
    return float(np.median(advancing)) if len(advancing) else 1.0


def runs(holds: BoolArray) -> list[tuple[int, int]]:
    """First frame, and the one after the last, of each run of frames (F,) in which something holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], holds.astype(np.int8), [0]]))).tolist()
    return list(zip(edges[::2], edges[1::2], strict=True))


def columns_at(at: Array | IndexArray, known: Array | IndexArray, values: Array) -> Array:
    """Columns (K, N) known at rising places (K,), interpolated linearly at (F,), as (F, N); flat beyond."""
    return np.stack([np.interp(at, known, column) for column in np.asarray(values).T], axis=-1)


def gaussian(values: Array, deviation: float, truncate: float = 4.0) -> Array:
    """Values (F, ...) under a Gaussian of a `deviation` in rows, which ends after `truncate` deviations."""
    if len(values) < 2 or not deviation > 0.0:
        return values
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(values, deviation, axis=0, mode="nearest", truncate=truncate))


def weighted_median(values: Array, weights: Array) -> float:
    """The value up to which, in order, half of the weights (N,) lie."""
    order = np.argsort(values)
    half = int(np.searchsorted(np.cumsum(weights[order]), 0.5 * weights.sum()))
    return float(values[order[min(half, len(order) - 1)]])
