"""Frames proposed as keyframes, from the markers' summed speed V_sum.

The paper poses its keyframes where V_sum (eq. 8) is small: there a posture is held, the image is sharp and
a mistimed keyframe costs least. Minima alone leave fast stretches without support, which measured worse
than even spacing; so keyframes are spaced evenly first and then moved to a minimum nearby.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, IndexArray
from ..errors import InputError

KEYFRAMES_PER_100_FRAMES = 10.0
SNAP_SHARE = 0.35
"""Largest shift of a keyframe from its evenly spaced frame, in even gaps; below 0.5, so that none overtakes
another."""
GAP_SLACK = 1.5
"""Default of the largest gap, in even gaps."""


def propose_keyframes(
    speed: ArrayLike, count: int | None = None, largest_gap: int | None = None
) -> IndexArray:
    """Propose keyframes: evenly spaced frames, each moved to a minimum of the speed nearby.

    The first and the last frame are always included.

    Args:
        speed: (F,) V_sum; a NaN is never chosen as a minimum.
        count: Number of keyframes; 10 per 100 frames where None. `largest_gap` may require more.
        largest_gap: Most frames from one keyframe to the next; 1.5 even gaps where None.

    Returns:
        (K,) increasing frame indices.

    Raises:
        InputError: Fewer than two frames, a count that is not between 2 and F, or a gap below 1.
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
    # Within this reach the next keyframe's evenly spaced frame stays allowed for any choice of this one.
    reach = min(int(SNAP_SHARE * spacing.min()), largest_gap - int(spacing.max()))
    chosen = even.copy()
    for i in range(1, len(even) - 1):
        last = min(even[i] + reach, chosen[i - 1] + largest_gap)
        window = np.arange(even[i] - reach, last + 1)
        window = window[minimum[window]]
        if len(window):
            chosen[i] = min(window, key=lambda frame: (V[frame], abs(frame - even[i])))
    return chosen
