"""How fast the markers move in the image, and where keyframes are therefore best posed.

The paper poses its keyframes where V_sum (eq. 8) is small: there a posture is held, the image is sharp and
a mistimed keyframe costs least. Minima alone leave fast stretches without support, which measured worse
than even spacing; so keyframes are spaced evenly first and then moved to a minimum nearby.
"""

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import gaussian_filter1d

from ..arrays import Array, IndexArray
from ..errors import InputError
from ..footage.region_tracks import RegionTracks

KEYFRAMES_PER_100_FRAMES = 10.0
SMOOTHING_FRAMES = 1.0
SNAP_SHARE = 0.35
"""How far a keyframe may leave its even place, in even gaps; below a half, so that none overtakes another."""
GAP_SLACK = 1.5
"""The largest gap where none is asked for, in even gaps."""


def marker_speed(tracks: RegionTracks, smoothing_frames: float = SMOOTHING_FRAMES) -> Array:
    """V_sum(t), the sum of the speeds of the markers' centroids in the image (paper, eq. 8).

    The text calls it a square sum, the equation is a sum of speeds; the equation is followed. A hidden
    marker moves evenly from where it vanished to where it reappears; before its first and after its last
    sight it keeps its nearest known speed, so that hiding alone makes no minimum. A marker that is seen in
    fewer than two frames adds nothing.

    Args:
        tracks: F frames of M regions; uneven time stamps are respected.
        smoothing_frames: standard deviation of a Gaussian over the sum [frames]; 0 for none.

    Returns:
        (F,) [px per frame of the clip's median duration].
    """
    time = _frame_times(tracks.time_s)
    total = np.zeros(tracks.frame_count)
    for marker in range(len(tracks.names)):
        total += _speed(tracks.centroid[:, marker], time)
    if smoothing_frames > 0.0 and len(total) > 1:
        total = np.asarray(gaussian_filter1d(total, smoothing_frames, mode="nearest"))
    return total


def _frame_times(time_s: Array) -> Array:
    """Time stamps (F,) in median frame durations; a stamp that does not advance counts as one duration."""
    step = np.diff(time_s)
    advancing = np.isfinite(step) & (step > 0.0)
    usual = float(np.median(step[advancing])) if advancing.any() else 1.0
    return np.concatenate([[0.0], np.cumsum(np.where(advancing, step / usual, 1.0))])


def _speed(centroid: Array, time: Array) -> Array:
    """Speed (F,) of one centroid (F, 2) [px]; zero where it is seen in fewer than two frames."""
    seen = np.flatnonzero(np.all(np.isfinite(centroid), axis=-1))
    if len(seen) < 2:
        return np.zeros(len(time))
    within = slice(seen[0], seen[-1] + 1)
    path = np.stack([np.interp(time[within], time[seen], centroid[seen, axis]) for axis in (0, 1)], axis=-1)
    speed = np.linalg.norm(np.gradient(path, time[within], axis=0), axis=-1)
    return np.asarray(np.interp(np.arange(len(time)), np.arange(seen[0], seen[-1] + 1), speed))


def propose_keyframes(
    speed: ArrayLike, count: int | None = None, largest_gap: int | None = None
) -> IndexArray:
    """Frames worth posing: evenly spaced, then moved to a minimum of the speed nearby.

    The first and the last frame are always among them.

    Args:
        speed: (F,) V_sum; a NaN is never chosen as a minimum.
        count: how many keyframes; 10 per 100 frames where None. More are proposed where `largest_gap`
            needs them.
        largest_gap: most frames from one keyframe to the next; 1.5 even gaps where None.

    Returns:
        (K,) increasing indices.

    Raises:
        InputError: fewer than two frames, a count that is not between 2 and F, or a gap below 1.
    """
    V = np.asarray(speed, dtype=np.float64)
    frames = len(V)
    if frames < 2:
        raise InputError(f"the clip has {frames} frame(s); keyframes can be proposed for 2 or more")
    if count is not None and not 2 <= count <= frames:
        raise InputError(
            f"keyframe count is {count}; a count between 2 and the clip's {frames} frames is valid"
        )
    if largest_gap is not None and largest_gap < 1:
        raise InputError(f"largest keyframe gap is {largest_gap} frames; a gap of 1 frame or more is valid")
    wanted = count if count is not None else round(frames * KEYFRAMES_PER_100_FRAMES / 100.0)
    if largest_gap is not None:
        wanted = max(wanted, math.ceil((frames - 1) / largest_gap) + 1)
    even = np.rint(np.linspace(0, frames - 1, min(max(wanted, 2), frames))).astype(np.intp)
    gap = (frames - 1) / (len(even) - 1)
    return _snap(V, even, largest_gap if largest_gap is not None else math.ceil(GAP_SLACK * gap))


def _snap(V: Array, even: IndexArray, largest_gap: int) -> IndexArray:
    """Move inner keyframes to the lowest minimum within reach, keeping every gap at most `largest_gap`."""
    V = np.where(np.isfinite(V), V, np.inf)
    padded = np.concatenate([[np.inf], V, [np.inf]])
    minimum = np.isfinite(V) & (V <= padded[:-2]) & (V <= padded[2:])
    spacing = np.diff(even)
    # With this reach the even place of the next keyframe stays allowed whatever is chosen for this one.
    reach = min(int(SNAP_SHARE * spacing.min()), largest_gap - int(spacing.max()))
    chosen = even.copy()
    for i in range(1, len(even) - 1):
        last = min(even[i] + reach, chosen[i - 1] + largest_gap)
        window = np.arange(even[i] - reach, last + 1)
        window = window[minimum[window]]
        if len(window):
            chosen[i] = min(window, key=lambda frame: (V[frame], abs(frame - even[i])))
    return chosen
