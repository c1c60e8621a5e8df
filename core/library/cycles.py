"""Motions that repeat themselves: how long a cycle is, how far it leads, and the average one."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.heading import headings_rad, turned_and_shifted, yaw_rotation
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.posture_spline import linear_spline
from .library import Travel
from .posture_shape import shape_vectors

FEWEST_CYCLES = 1.9
"""So many must be seen: two, but for what is missing at the clip's ends."""
SHORTEST_S = 0.25
MOST_UNLIKE = 0.2
"""Mean square difference of shapes a cycle apart, over that of unrelated ones."""
AS_GOOD = 0.05
"""Of two lags that differ less in that, the shorter is the cycle and the longer two of them."""
STILL_M = 0.02
"""A body whose shape varies less than this does not move."""


@dataclass(frozen=True, eq=False)
class Cycle:
    """One cycle of a motion."""

    posture: Posture
    """A batch of N postures, evenly timed, the first at the cycle's beginning."""
    time_s: Array
    """(N,) from the cycle's beginning [s]."""
    duration_s: float
    travel: Travel
    """What a cycle adds to the place and, about the world's vertical axis, to the heading."""


def find_period_s(shape: Array, time_s: Array) -> float | None:
    """How long a motion takes to come back to what it was; None where it does not, or is seen once only.

    Args:
        shape: (F, N) the body's shape in each frame [m].
        time_s: (F,) rising times [s].
    """
    count = len(shape)
    if count < 8:
        return None
    step_s = (time_s[-1] - time_s[0]) / (count - 1)
    even = time_s[0] + step_s * np.arange(count)
    rows = np.stack([np.interp(even, time_s, column) for column in shape.T], axis=1)
    rows -= rows.mean(axis=0)
    if np.sqrt(np.sum(rows**2, axis=1).mean()) < STILL_M:
        return None
    unlike = _unlikeness(rows)[: int((count - 1) / FEWEST_CYCLES) + 1]
    lags = np.arange(1, len(unlike) - 1)
    lowest = lags[(unlike[1:-1] <= unlike[:-2]) & (unlike[1:-1] < unlike[2:])]
    lowest = lowest[(unlike[lowest] < MOST_UNLIKE) & (lowest * step_s >= SHORTEST_S)]
    if not len(lowest):
        return None
    lag = int(lowest[unlike[lowest] <= unlike[lowest].min() + AS_GOOD][0])
    left, middle, right = unlike[lag - 1 : lag + 2]
    bend = left - 2.0 * middle + right
    return float(step_s * (lag + (0.5 * (left - right) / bend if bend > 0.0 else 0.0)))


def _unlikeness(rows: Array) -> Array:
    """Mean square difference of rows a lag apart over what it is where they are unrelated, for each lag."""
    count = len(rows)
    spectrum = np.fft.rfft(rows, n=2 * count, axis=0)
    product = np.fft.irfft(np.sum(np.abs(spectrum) ** 2, axis=1), n=2 * count)[:count]
    energy = np.concatenate([[0.0], np.cumsum(np.sum(rows**2, axis=1))])
    lag = np.arange(count)
    both = energy[count - lag] + energy[count] - energy[lag]  # of the first and of the last count - lag rows
    return np.asarray(np.maximum(both - 2.0 * product, 0.0) / np.maximum(both, 1e-12))


def average_cycle(body: Body, posture: Posture, time_s: Array, period_s: float) -> Cycle:
    """The mean of a motion's whole cycles, closed so that its end meets its beginning a cycle later.

    Args:
        body: The performer.
        posture: A batch of F postures.
        time_s: (F,) rising times [s].
        period_s: What `find_period_s` found.
    """
    shape = shape_vectors(body, posture)
    begin_s, cycles = _whole_cycles(shape, time_s, period_s)
    count = max(8, round(period_s * (len(time_s) - 1) / (time_s[-1] - time_s[0])))
    phase_s = period_s * np.arange(count + 1) / count  # the last is the next cycle's first
    turn, step = _cycle_step(posture, time_s, period_s)
    seen = []
    for cycle in range(cycles):
        there = linear_spline(posture, time_s, begin_s + cycle * period_s + phase_s)
        for _ in range(cycle):  # back to where the first cycle was
            there = turned_and_shifted(turned_and_shifted(there, 0.0, -step), -turn, np.zeros(3))
        seen.append(there)
    mean = _mean(seen)
    again = turned_and_shifted(mean[:1], turn, step)
    gap = again.minus(mean[count:])[0]  # (D,) what the end misses
    closed = mean.plus((phase_s / period_s)[:, None] * gap)
    return Cycle(closed[:count], phase_s[:count], period_s, (float(step[0]), float(step[1]), turn))


def _whole_cycles(shape: Array, time_s: Array, period_s: float) -> tuple[float, int]:
    """The time at which as many whole cycles as there are begin, and their number."""
    lasted = time_s[-1] - time_s[0]
    cycles = max(int(lasted / period_s), 1)
    starts = time_s[time_s <= time_s[-1] - cycles * period_s + 1e-9]
    ends = starts + cycles * period_s
    there = np.stack([np.interp(ends, time_s, column) for column in shape.T], axis=1)
    apart = np.linalg.norm(there - shape[: len(starts)], axis=1)
    return float(starts[apart.argmin()]), cycles


def _cycle_step(posture: Posture, time_s: Array, period_s: float) -> tuple[float, Array]:
    """The turn about the vertical [rad] and then the shift (3,) [m] that lead from a cycle to the next."""
    now = time_s <= time_s[-1] - period_s
    later = linear_spline(posture, time_s, time_s[now] + period_s)
    turned = headings_rad(later) - headings_rad(posture[now])
    turn = float(np.arctan2(np.sin(turned).mean(), np.cos(turned).mean()))
    step = (later.translation - posture[now].translation @ yaw_rotation(turn).T).mean(axis=0)
    return turn, np.asarray(step * [1.0, 1.0, 0.0])


def _mean(batches: list[Posture]) -> Posture:
    """The mean of several batches, posture by posture."""
    mean = batches[0]
    for _ in range(2):  # of rotations this near to each other, the second step is exact to the eye
        mean = mean.plus(np.mean([batch.minus(mean) for batch in batches], axis=0))
    return mean
