"""What moves the hips: legs that stand and must reach, and the way over the ground."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array, BoolArray
from ...body.posture import yaw_rotation
from ...feet.fading import ease, smooth_above, smoothed
from .two_bone import STRAIGHTEST, LimbPose

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
