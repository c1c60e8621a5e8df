"""Hips: moved with what the standing feet are moved by, and lowered where a limb cannot reach.

Both keep knees from bending: a nearly straight leg answers a centimeter with ten degrees.
"""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array, BoolArray
from .smoothing import ease, smooth_above, smoothed
from .two_bone import STRAIGHTEST, LimbPose

LEG_SOFT = 0.988
"""Share of its length from which a leg resists being stretched."""
SINK_S = 0.12
"""Time over which the hips go down and up again."""
CARRY_S = 0.08
"""Standard deviation in time of the smoothing of what they are moved by with the feet."""
MOMENT_S = 0.07
"""Standard deviation in time of the smoothing of how far a limb may be stretched."""
DEEPEST_SHARE = 0.08
"""Farthest that they go down or up, as a share of the legs' length."""
STANDING_SHARE = 0.04
"""Height of an ankle over its height on the ground, as a share of the leg, from which it does not stand."""
STRAIGHT = 0.01
"""What a leg is longer than the way between its ends, as a share, when it counts as nearly straight."""
LEAST_WEIGHT = 1.0
"""What standing legs are weighed against: a bent leg that stands has about 20, a straight one 100."""


def needed_drop_m(limb: LimbPose, goal: Array, needed: BoolArray, soft: float, time_s: Array) -> Array:
    """(F,) how much lower a limb must begin to reach its goal [m].

    Args:
        limb: The limb by the performer's directions.
        goal: (F, 3) ankle or wrist [m].
        needed: (F,) whether the goal must be reached.
        soft: Share of its length from which the limb resists.
        time_s: (F,) time of each frame [s].
    """
    own = np.minimum(limb.extension_m / limb.length_m, 1.0)
    # A knee that is straight for a moment only is not stretched to the limit for it: it would snap.
    allowed = np.maximum(soft, np.minimum(own, smoothed(own, time_s, MOMENT_S, ends_kept=False)))
    way = goal - limb.start
    aside = np.sum(way[:, :2] ** 2, axis=-1)
    below = np.sqrt(np.maximum((allowed * STRAIGHTEST * limb.length_m) ** 2 - aside, 0.0))
    return np.where(needed, np.maximum(-way[:, 2] - below, 0.0), 0.0)


def straightness(limb: LimbPose) -> Array:
    """(F,) how much a limb bends for a little way: a weight, large where it is nearly straight."""
    return np.asarray(1.0 / (STRAIGHT + np.maximum(1.0 - limb.extension_m / limb.length_m, 0.0)))


def raised_m(
    legs: Sequence[LimbPose], ankles: Sequence[Array], over_m: Sequence[Array], time_s: Array, leg_m: float
) -> Array:
    """(F,) how much higher the hips go, or lower, for the legs that stand to keep their bend [m].

    Args:
        legs: The legs by the performer's directions.
        ankles: (F, 3) where their ankles shall be [m].
        over_m: (F,) how much higher that is than an ankle on the ground [m].
        time_s: (F,) time of each frame [s].
        leg_m: Length of the legs [m].
    """
    total, weights = np.zeros(len(time_s)), np.full(len(time_s), LEAST_WEIGHT)
    for leg, ankle, over in zip(legs, ankles, over_m, strict=True):
        weight = straightness(leg) * (1.0 - ease(over, 0.0, STANDING_SHARE * leg_m))
        total += weight * (ankle - leg.end)[:, 2]
        weights += weight
    limit = DEEPEST_SHARE * leg_m
    return np.clip(smoothed(total / weights, time_s, CARRY_S, ends_kept=False), -limit, limit)


def lowered_m(needed: list[Array], time_s: Array, leg_m: float) -> Array:
    """(F,) how much lower the hips go, smoothly, for what their limbs need [m]."""
    highest = np.minimum(np.maximum.reduce(needed), DEEPEST_SHARE * leg_m)
    return smooth_above(highest, time_s, SINK_S)
