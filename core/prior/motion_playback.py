"""Motions over time: shapes of postures for comparing them, periods and average cycles, and playback."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.body_volume import lower_sole_m
from ..body.kinematics import Body
from ..body.posture import UP, Posture, headings_rad, turned_and_shifted, yaw_rotation, yawed_at
from ..body.posture_spline import cubic_spline, find_intervals, linear_spline
from ..body.skeleton import SIDES
from ..numerics.vectors import columns_at
from .library import Library, LibraryMotion, Travel
from .transfer import transferred


def shape_vectors(body: Body, posture: Posture) -> Array:
    """Shape vectors (F, 3 P); their distance is the root mean square distance of the points [m].

    They are the principal points relative to the ground below the hips, the performer facing -Y.
    """
    points = body.points(body.pose(posture))
    ground = posture.translation * [1.0, 1.0, 0.0]
    turn = yaw_rotation(-headings_rad(posture))
    seen = (points - ground[..., None, :]) @ np.swapaxes(turn, -1, -2)
    return np.asarray(seen.reshape(*posture.batch, -1) / np.sqrt(points.shape[-2]))


def ankle_heights(body: Body, posture: Posture) -> Array:
    """Heights (F, 2) of the left and the right ankle over those of feet flat on z = 0 [m].

    Ankles tell the floor's height, as soles do not: the skeleton's feet, rigid with the shins, point into the
    floor at the end of a step.
    """
    points = body.points(body.pose(posture))
    ankles = [body.skeleton.point_names.index(f"ankle.{side}") for side in SIDES]
    below = [0.36 * body.actor.segments_m[f"foot.{side}"] for side in SIDES]
    return np.asarray(points[..., ankles, 2] - below)


# --- Periodic motions


@dataclass(frozen=True, eq=False)
class Cycle:
    """One cycle of a motion."""

    posture: Posture  # a batch of N postures at equal intervals, the first at the cycle's beginning
    time_s: Array  # (N,) from the cycle's beginning [s]
    duration_s: float
    travel: Travel  # displacement of a cycle, and its turn about the world's vertical axis


def find_period_s(shape: Array, time_s: Array) -> float | None:
    """Period of a motion; None if it is not periodic, or shows fewer than two cycles.

    `shape` (F, N) is the body's in each frame [m].
    """
    count = len(shape)
    if count < 8:
        return None
    step_s = (time_s[-1] - time_s[0]) / (count - 1)
    even = time_s[0] + step_s * np.arange(count)
    rows = columns_at(even, time_s, shape)
    rows -= rows.mean(axis=0)
    if np.sqrt(np.sum(rows**2, axis=1).mean()) < 0.02:  # motionless [m]
        return None
    # A motion must contain two cycles, but for what is cut off at the clip's ends.
    unlike = _unlikeness(rows)[: int((count - 1) / 1.9) + 1]
    lags = np.arange(1, len(unlike) - 1)
    lowest = lags[(unlike[1:-1] <= unlike[:-2]) & (unlike[1:-1] < unlike[2:])]
    lowest = lowest[
        (unlike[lowest] < 0.2) & (lowest * step_s >= 0.25)
    ]  # of a cycle: alike, and no shorter [s]
    if not len(lowest):
        return None
    # Of lags that are about as good the shortest is the period, and longer ones its multiples.
    lag = int(lowest[unlike[lowest] <= unlike[lowest].min() + 0.05][0])
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
    """The mean of a motion's whole cycles, closed so that its end meets the next cycle's beginning."""
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
    mean = batches[0]
    for _ in range(2):  # for rotations this close the second step is accurate enough
        mean = mean.plus(np.mean([batch.minus(mean) for batch in batches], axis=0))
    return mean


# --- Playback


NEIGHBORS = 2  # postures before and after a cycle that the spline within it depends on


def sample_motion(library: Library, motion: LibraryMotion, body: Body, time_s: Array) -> Posture:
    """The postures of a motion at any times, on a spline through those of its steps.

    A cyclic motion continues without end, before time 0 too, and travels with every cycle; any other holds
    its first posture before its beginning and its last one after its end. Between two steps the lowest sole
    stays between its heights in both of them: a foot on the floor stays there.
    """
    posed = Posture.stack([library.by_name[step.posture].posture for step in motion.steps])
    knots = np.array([step.time_s for step in motion.steps])
    at = np.asarray(time_s, dtype=np.float64)
    if not motion.cyclic:
        return transferred(_interpolated(library, posed, knots, at), library.actor, body)
    cycle = np.floor(at / motion.duration_s)
    around = np.arange(-NEIGHBORS, len(knots) + NEIGHBORS)
    turn, step = np.divmod(around, len(knots))
    spline = _interpolated(
        library,
        after_cycles(posed[step], motion, turn),
        knots[step] + turn * motion.duration_s,
        at - cycle * motion.duration_s,
    )
    return transferred(after_cycles(spline, motion, cycle), library.actor, body)


def after_cycles(posture: Posture, motion: LibraryMotion, cycles: Array) -> Posture:
    """Postures moved by the travel of some cycles, later or earlier ones.

    A cycle turns a point about the world's origin by the travel's heading, then shifts it by x and y.

    `cycles` (N,): whole numbers, negative for earlier ones.
    """
    *way, heading = motion.travel
    angle = np.asarray(cycles) * heading
    # The sum of the turned shifts of all cycles is a geometric series; sin(n h / 2) / sin(h / 2) is its size.
    half = 0.5 * np.remainder(heading + np.pi, 2.0 * np.pi) - 0.5 * np.pi
    size = np.asarray(cycles) if abs(half) < 1e-9 else np.sin(cycles * half) / np.sin(half)
    direction = yaw_rotation((np.asarray(cycles) - 1.0) * half)
    moved = size[:, None] * (direction @ np.array([*way, 0.0]))
    hips = (yaw_rotation(angle) @ posture.translation[..., None])[..., 0] + moved
    return yawed_at(posture, angle, hips)


def _interpolated(library: Library, posed: Posture, knots: Array, at: Array) -> Posture:
    """Postures (T,) on a spline through the knots, with soles no lower and no higher than at both knots."""
    if len(knots) == 1:
        return posed[np.zeros(len(at), dtype=np.intp)]
    spline = cubic_spline(posed, knots, at)
    body = Body(library.actor, posed.skeleton)
    interval, _ = find_intervals(knots, at)
    posed_m = lower_sole_m(body, posed)
    height = lower_sole_m(body, spline)
    low = np.minimum(posed_m[:-1], posed_m[1:])[interval]
    high = np.maximum(posed_m[:-1], posed_m[1:])[interval]
    lift = np.clip(height, low, high) - height
    return Posture(spline.skeleton, spline.translation + lift[:, None] * UP, spline.rotations, spline.angles)
