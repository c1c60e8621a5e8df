"""Periodic motions: their period, the travel of a cycle, and the average cycle."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.heading import headings_rad, turned_and_shifted, yaw_rotation
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.posture_spline import linear_spline
from ..numerics.smoothing import columns_at
from .library import Travel
from .posture_shape import shape_vectors

FEWEST_CYCLES = 1.9
"""Cycles a motion must contain: two, but for what is cut off at the clip's ends."""
SHORTEST_S = 0.25
MOST_UNLIKE = 0.2
"""Largest normalized difference of shapes one period apart."""
AS_GOOD = 0.05
"""Tolerance in that difference within which the shortest lag is the period, and longer ones its multiples."""
STILL_M = 0.02
"""Variation of the body's shape below which it counts as motionless."""


@dataclass(frozen=True, eq=False)
class Cycle:
    """One cycle of a motion."""

    posture: Posture
    """A batch of N postures at equal intervals, the first at the cycle's beginning."""
    time_s: Array
    """(N,) from the cycle's beginning [s]."""
    duration_s: float
    travel: Travel
    """Displacement of a cycle, and its turn about the world's vertical axis."""


def find_period_s(shape: Array, time_s: Array) -> float | None:
    """Period of a motion; None if it is not periodic, or shows fewer than two cycles.

    Args:
        shape: (F, N) the body's shape in each frame [m].
        time_s: (F,) rising times [s].
    """
    count = len(shape)
    if count < 8:
        return None
    step_s = (time_s[-1] - time_s[0]) / (count - 1)
    even = time_s[0] + step_s * np.arange(count)
    rows = columns_at(even, time_s, shape)
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
    """For each lag, the mean square difference of rows that far apart, normalized to 1 for unrelated rows.

    Computed by the FFT of the autocorrelation.
    """
    count = len(rows)
    spectrum = np.fft.rfft(rows, n=2 * count, axis=0)
    product = np.fft.irfft(np.sum(np.abs(spectrum) ** 2, axis=1), n=2 * count)[:count]
    energy = np.concatenate([[0.0], np.cumsum(np.sum(rows**2, axis=1))])
    lag = np.arange(count)
    both = energy[count - lag] + energy[count] - energy[lag]  # of the first and of the last count - lag rows
    return np.asarray(np.maximum(both - 2.0 * product, 0.0) / np.maximum(both, 1e-12))


def average_cycle(body: Body, posture: Posture, time_s: Array, period_s: float) -> Cycle:
    """The mean of a motion's whole cycles, closed so that its end meets the next cycle's beginning.

    Args:
        body: The performer.
        posture: A batch of F postures.
        time_s: (F,) rising times [s].
        period_s: The period, from `find_period_s`.
    """
    shape = shape_vectors(body, posture)
    begin_s, cycles = _whole_cycles(shape, time_s, period_s)
    count = max(8, round(period_s * (len(time_s) - 1) / (time_s[-1] - time_s[0])))
    phase_s = period_s * np.arange(count + 1) / count  # the last is the next cycle's first
    turn, step = _cycle_step(posture, time_s, period_s)
    seen = []
    for cycle in range(cycles):
        there = linear_spline(posture, time_s, begin_s + cycle * period_s + phase_s)
        for _ in range(cycle):  # move it back onto the first cycle
            there = turned_and_shifted(turned_and_shifted(there, 0.0, -step), -turn, np.zeros(3))
        seen.append(there)
    mean = _mean(seen)
    again = turned_and_shifted(mean[:1], turn, step)
    gap = again.minus(mean[count:])[0]  # (D,) closing error
    closed = mean.plus((phase_s / period_s)[:, None] * gap)
    return Cycle(closed[:count], phase_s[:count], period_s, (float(step[0]), float(step[1]), turn))


def _whole_cycles(shape: Array, time_s: Array, period_s: float) -> tuple[float, int]:
    """Time at which the whole cycles begin, and their number."""
    lasted = time_s[-1] - time_s[0]
    cycles = max(int(lasted / period_s), 1)
    starts = time_s[time_s <= time_s[-1] - cycles * period_s + 1e-9]
    ends = starts + cycles * period_s
    there = columns_at(ends, time_s, shape)
    apart = np.linalg.norm(there - shape[: len(starts)], axis=1)
    return float(starts[apart.argmin()]), cycles


def _cycle_step(posture: Posture, time_s: Array, period_s: float) -> tuple[float, Array]:
    """Turn about the vertical [rad] and subsequent shift (3,) [m] from a cycle to the next."""
    now = time_s <= time_s[-1] - period_s
    later = linear_spline(posture, time_s, time_s[now] + period_s)
    turned = headings_rad(later) - headings_rad(posture[now])
    turn = float(np.arctan2(np.sin(turned).mean(), np.cos(turned).mean()))
    step = (later.translation - posture[now].translation @ yaw_rotation(turn).T).mean(axis=0)
    return turn, np.asarray(step * [1.0, 1.0, 0.0])


def _mean(batches: list[Posture]) -> Posture:
    """The mean of several batches, posture by posture."""
    mean = batches[0]
    for _ in range(2):  # for rotations this close the second step is accurate enough
        mean = mean.plus(np.mean([batch.minus(mean) for batch in batches], axis=0))
    return mean
