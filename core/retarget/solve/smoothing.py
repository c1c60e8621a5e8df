"""Signals over time: speeds, values eased between two bounds, smoothed, or smoothly kept above others."""

import numpy as np
from scipy.ndimage import convolve1d, maximum_filter1d

from ...arrays import Array
from ...finish.foot_ground import smooth_step
from ...numerics.smoothing import columns_at, gaussian


def ease(value: Array, start: float, end: float) -> Array:
    """0 up to `start`, 1 from `end` on (or the other way round, where `end` is below), smooth between."""
    return smooth_step((np.asarray(value) - start) / (end - start))


def speeds(path: Array, time_s: Array) -> Array:
    """(F,) speed along a path (F, 3) [m/s]."""
    if len(path) < 2:
        return np.zeros(len(path))
    return np.asarray(np.linalg.norm(np.gradient(path, time_s, axis=0), axis=-1))


def smoothed(values: Array, time_s: Array, deviation_s: float, ends_kept: bool = True) -> Array:
    """Values (F, ...) smoothed by a Gaussian in time.

    Args:
        values: (F, ...).
        time_s: (F,) time of each frame [s].
        deviation_s: Standard deviation of the Gaussian [s].
        ends_kept: Whether the first and last values stay and slopes go on beyond them, as a way's do; else
            they are as smooth as all others.
    """
    if len(values) < 3:
        return np.array(values)
    even, step = _evenly(time_s)
    columns = values.reshape(len(values), -1)
    sampled = columns_at(even, time_s, columns)
    reach = min(len(even) - 1, int(np.ceil(4.0 * deviation_s / step)))
    before, after = sampled[reach:0:-1], sampled[-2 : -reach - 2 : -1]
    if ends_kept:
        # Mirrored in value, too, about either end, so that the ends do not lag behind.
        before, after = 2.0 * sampled[0] - before, 2.0 * sampled[-1] - after
    extended = np.concatenate([before, sampled, after])
    filtered = gaussian(extended, deviation_s / step)[reach : reach + len(even)]
    back = columns_at(time_s, even, filtered)
    return back.reshape(values.shape)


def smooth_above(needed: Array, time_s: Array, reach_s: float) -> Array:
    """A smooth signal (F,) that is nowhere below the needed one: its running maximum, smoothed.

    Args:
        needed: (F,).
        time_s: (F,) time of each frame [s].
        reach_s: Time over which it rises and falls to either side [s].
    """
    if len(needed) < 3 or not needed.any():
        return np.array(needed)
    step = float(np.median(np.diff(time_s)))
    frames = max(1, int(np.ceil(reach_s / step)))
    highest = maximum_filter1d(needed, 2 * frames + 1, mode="nearest")
    window = np.hanning(2 * frames + 3)[1:-1]
    return np.asarray(convolve1d(highest, window / window.sum(), mode="nearest"))


def _evenly(time_s: Array) -> tuple[Array, float]:
    """As many even times as there are frames, and the step between them [s]."""
    even = np.linspace(time_s[0], time_s[-1], len(time_s))
    return even, max(float(even[1] - even[0]), 1e-6)
