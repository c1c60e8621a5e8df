"""Corrections that fade, signals over time, and what moves the hips and the way over the ground."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array, BoolArray
from ...body.posture import yaw_rotation
from ...finish.foot_ground import smooth_above, smooth_step
from ...numerics.vectors import columns_at, gaussian
from .two_bone import STRAIGHTEST, LimbPose

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


# --- Signals over time


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

    With `ends_kept` the first and last values stay and slopes go on beyond them, as a way's do; else they are
    as smooth as all others.
    """
    if len(values) < 3:
        return np.array(values)
    even = np.linspace(time_s[0], time_s[-1], len(time_s))
    step = max(float(even[1] - even[0]), 1e-6)
    columns = values.reshape(len(values), -1)
    sampled = columns_at(even, time_s, columns)
    reach = min(len(even) - 1, int(np.ceil(4.0 * deviation_s / step)))
    before, after = sampled[reach:0:-1], sampled[-2 : -reach - 2 : -1]
    if ends_kept:
        # Mirrored in value, too, about either end, so that the ends do not lag behind.
        before, after = 2.0 * sampled[0] - before, 2.0 * sampled[-1] - after
    extended = np.concatenate([before, sampled, after])
    filtered = gaussian(extended, deviation_s / step)[reach : reach + len(even)]
    return columns_at(time_s, even, filtered).reshape(values.shape)


# --- Hips


LEG_SOFT = 0.988  # share of its length from which a leg resists being stretched
SINK_S = 0.12  # time over which the hips go down and up again
CARRY_S = 0.08  # standard deviation in time of the smoothing of what they are moved by with the feet
MOMENT_S = 0.07  # standard deviation in time of the smoothing of how far a limb may be stretched
DEEPEST_SHARE = 0.08  # farthest that they go down or up, as a share of the legs' length


def needed_drop_m(limb: LimbPose, goal: Array, needed: BoolArray, soft: float, time_s: Array) -> Array:
    """(F,) how much lower a limb must begin to reach its goal (F, 3) where that is needed (F,) [m]."""
    own = np.minimum(limb.extension_m / limb.length_m, 1.0)
    # A knee that is straight for a moment only is not stretched to the limit for it: it would snap.
    allowed = np.maximum(soft, np.minimum(own, smoothed(own, time_s, MOMENT_S, ends_kept=False)))
    way = goal - limb.start
    aside = np.sum(way[:, :2] ** 2, axis=-1)
    below = np.sqrt(np.maximum((allowed * STRAIGHTEST * limb.length_m) ** 2 - aside, 0.0))
    return np.where(needed, np.maximum(-way[:, 2] - below, 0.0), 0.0)


def straightness(limb: LimbPose) -> Array:
    """(F,) how much a limb bends for a little way: a weight, large where it is nearly straight."""
    # What a leg is longer than the way between its ends, as a share, when it counts as nearly straight.
    return np.asarray(1.0 / (0.01 + np.maximum(1.0 - limb.extension_m / limb.length_m, 0.0)))


def raised_m(
    legs: Sequence[LimbPose], ankles: Sequence[Array], over_m: Sequence[Array], time_s: Array, leg_m: float
) -> Array:
    """(F,) how much higher the hips go, or lower, for the legs that stand to keep their bend [m].

    `over_m` (F,) is how much higher the ankles (F, 3) shall be than ankles on the ground.
    """
    # What standing legs are weighed against: a bent leg that stands has about 20, a straight one 100.
    total, weights = np.zeros(len(time_s)), np.full(len(time_s), 1.0)
    for leg, ankle, over in zip(legs, ankles, over_m, strict=True):
        # Height of an ankle over its height on the ground, as a share of the leg, from which it does not
        # stand.
        weight = straightness(leg) * (1.0 - ease(over, 0.0, 0.04 * leg_m))
        total += weight * (ankle - leg.end)[:, 2]
        weights += weight
    limit = DEEPEST_SHARE * leg_m
    return np.clip(smoothed(total / weights, time_s, CARRY_S, ends_kept=False), -limit, limit)


def lowered_m(needed: list[Array], time_s: Array, leg_m: float) -> Array:
    """(F,) how much lower the hips go, smoothly, for what their limbs need [m]."""
    highest = np.minimum(np.maximum.reduce(needed), DEEPEST_SHARE * leg_m)
    return smooth_above(highest, time_s, SINK_S)


# --- The way over the ground


WAY_S = 0.4  # standard deviation in time of what counts as the way and heading; faster changes are sway


def smooth_way(hips: Array, time_s: Array) -> Array:
    """(F, 3) the smoothed way of the hips over the ground from where they begin [m]; heights are 0."""
    way = smoothed(hips - hips[0], time_s, WAY_S) * [1.0, 1.0, 0.0]
    return way - way[0]


def smooth_headings_rad(headings_rad: Array, time_s: Array) -> Array:
    """(F,) smoothed headings from the first one."""
    return smoothed(np.unwrap(headings_rad) - headings_rad[0], time_s, WAY_S)


def root_poses(rest: Array, stand: Array, way: Array, heading_rad: Array) -> Array:
    """(F, 4, 4) poses of a root bone that goes along a way (F, 3) from where it stands, and turns [m]."""
    turn = yaw_rotation(heading_rad)
    poses = np.broadcast_to(np.eye(4), (len(way), 4, 4)).copy()
    poses[:, :3, :3] = turn @ rest[:3, :3]
    poses[:, :3, 3] = stand + way + turn @ (rest[:3, 3] - stand)
    return poses
