"""Holds: stretches of frames in which a path is replaced, and its fading correction on either side."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array

FADE_S = 0.2
"""Time in which a correction fades on either side of a hold."""


@dataclass(frozen=True, eq=False)
class Hold:
    """A stretch of frames with a correction."""

    first: int
    """Its first frame, from 0."""
    offset: Array
    """(N, 3) the correction in each of its N frames."""

    @property
    def last(self) -> int:
        """Its last frame, included."""
        return self.first + len(self.offset) - 1


def faded(holds: Sequence[Hold], time_s: Array, fade_s: float = FADE_S) -> Array:
    """(F, 3) the corrections of holds, fading on either side without a jump in place or speed.

    Two holds that follow each other closely are joined by one cubic.

    Args:
        holds: In order, none overlapping another.
        time_s: (F,) time of each frame [s].
        fade_s: Time in which a correction fades [s].
    """
    offset = np.zeros((len(time_s), 3))
    for hold in holds:
        offset[hold.first : hold.last + 1] = hold.offset
    for before, after in zip([None, *holds], [*holds, None], strict=True):
        left = -1 if before is None else before.last
        right = len(time_s) if after is None else after.first
        if right - left < 2:
            continue
        near = before is not None and after is not None and time_s[right] - time_s[left] <= 2.0 * fade_s
        if before is not None:
            end = time_s[right] if near else time_s[left] + fade_s
            share, span = _share(time_s[left + 1 : right], time_s[left], end)
            offset[left + 1 : right] += _cubic(share, before.offset[-1], span * _slope(before, time_s, -1))
        if after is not None:
            start = time_s[left] if near else time_s[right] - fade_s
            share, span = _share(time_s[left + 1 : right], time_s[right], start)
            offset[left + 1 : right] += _cubic(share, after.offset[0], span * _slope(after, time_s, 0))
    return offset


def _share(times: Array, edge: float, end: float) -> tuple[Array, float]:
    """Share of the fade at some times, up to 1, and its signed length [s]."""
    return np.clip((times - edge) / (end - edge), 0.0, 1.0), end - edge


def _cubic(share: Array, value: Array, slope: Array) -> Array:
    """From a value with a slope to zero without one; `slope` is that over the whole fade."""
    s = share[:, None]
    return np.asarray((1.0 - s) ** 2 * ((1.0 + 2.0 * s) * value + s * slope))


def _slope(hold: Hold, time_s: Array, edge: int) -> Array:
    """(3,) rate of the correction at the hold's first (0) or last (-1) frame."""
    if len(hold.offset) < 2:
        return np.zeros(3)
    first, second = (0, 1) if edge == 0 else (-2, -1)
    times = time_s[hold.first : hold.last + 1]
    return np.asarray((hold.offset[second] - hold.offset[first]) / (times[second] - times[first]))
