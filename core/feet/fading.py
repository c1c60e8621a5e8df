"""Signals that come and go smoothly: steps, needs, and corrections that fade on either side."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body import rotations
from ..numerics.vectors import columns_at, gaussian, usual_step
from .contacts import Contact

FADE_S = 0.2  # time in which a correction fades on either side of a hold


@dataclass(frozen=True, eq=False)
class Hold:
    """A stretch of frames with a correction."""

    first: int  # its first frame, from 0
    offset: Array  # (N, 3) the correction in each of its N frames

    @property
    def last(self) -> int:
        """Its last frame, included."""
        return self.first + len(self.offset) - 1


def faded(holds: Sequence[Hold], time_s: Array) -> Array:
    """(F, 3) the corrections of holds, fading on either side without a jump in place or speed.

    Holds are in order and do not overlap; two that follow each other closely are joined by one cubic.
    """
    offset = np.zeros((len(time_s), 3))
    for hold in holds:
        offset[hold.first : hold.last + 1] = hold.offset
    for before, after in zip([None, *holds], [*holds, None], strict=True):
        left = -1 if before is None else before.last
        right = len(time_s) if after is None else after.first
        if right - left < 2:
            continue
        near = before is not None and after is not None and time_s[right] - time_s[left] <= 2.0 * FADE_S
        between = slice(left + 1, right)
        if before is not None:
            end = time_s[right] if near else time_s[left] + FADE_S
            offset[between] += _fading(before, -1, time_s, between, end)
        if after is not None:
            start = time_s[left] if near else time_s[right] - FADE_S
            offset[between] += _fading(after, 0, time_s, between, start)
    return offset


def _fading(hold: Hold, edge: int, time_s: Array, frames: slice, end: float) -> Array:
    """A cubic from a hold's first (0) or last (-1) correction and its rate to zero at a time `end`."""
    times, rate = time_s[hold.first : hold.last + 1], np.zeros(3)
    if len(times) > 1:
        one, other = (0, 1) if edge == 0 else (-2, -1)
        rate = (hold.offset[other] - hold.offset[one]) / (times[other] - times[one])
    span = end - times[edge]
    s = np.clip((time_s[frames] - times[edge]) / span, 0.0, 1.0)[:, None]
    return np.asarray((1.0 - s) ** 2 * ((1.0 + 2.0 * s) * hold.offset[edge] + s * span * rate))


def held_turns(turns: Array, rests: Sequence[Contact], held: Sequence[Array], time_s: Array) -> Array:
    """Turns (F, 3, 3) that are one (3, 3) throughout each rest; what that changes fades beside it."""
    holds = [
        Hold(rest.first, rotations.logarithm(own @ np.swapaxes(turns[rest.frames], -1, -2)))
        for rest, own in zip(rests, held, strict=True)
    ]
    return np.asarray(rotations.exponential(faded(holds, time_s)) @ turns)


def ease(value: Array, start: float, end: float) -> Array:
    """0 up to `start`, 1 from `end` on (or the other way round, where `end` is below), smooth between."""
    s = np.clip((np.asarray(value) - start) / (end - start), 0.0, 1.0)
    return np.asarray(s * s * (3.0 - 2.0 * s))


def smooth_above(needed: Array, time_s: Array, reach_s: float) -> Array:
    """A smooth signal (F,) nowhere below the needed one: its running maximum over the reach, smoothed."""
    if len(needed) < 3 or not needed.any():
        return np.array(needed)
    from scipy.ndimage import convolve1d, maximum_filter1d

    frames = max(1, int(np.ceil(reach_s / usual_step(time_s))))
    highest = maximum_filter1d(needed, 2 * frames + 1, mode="nearest")
    window = np.hanning(2 * frames + 3)[1:-1]
    return np.asarray(convolve1d(highest, window / window.sum(), mode="nearest"))


def smoothed(values: Array, time_s: Array, deviation_s: float, ends_kept: bool = True) -> Array:
    """Values (F, ...) smoothed by a Gaussian in time.

    With `ends_kept` the first and last values stay and slopes go on beyond them, as a way's do; else they are
    as smooth as all others.
    """
    if len(values) < 3:
        return np.array(values)
    even = np.linspace(time_s[0], time_s[-1], len(time_s))
    step = max(float(even[1] - even[0]), 1e-6)
    sampled = columns_at(even, time_s, values.reshape(len(values), -1))
    reach = min(len(even) - 1, int(np.ceil(4.0 * deviation_s / step)))
    before, after = sampled[reach:0:-1], sampled[-2 : -reach - 2 : -1]
    if ends_kept:
        # Mirrored in value, too, about either end, so that the ends do not lag behind.
        before, after = 2.0 * sampled[0] - before, 2.0 * sampled[-1] - after
    filtered = gaussian(np.concatenate([before, sampled, after]), deviation_s / step)
    return columns_at(time_s, even, filtered[reach : reach + len(even)]).reshape(values.shape)
