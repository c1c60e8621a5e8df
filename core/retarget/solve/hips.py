"""What moves the hips: legs that stand, and limbs that must reach."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array, BoolArray
from ...feet.fading import ease, smoothed
from .two_bone import STRAIGHTEST, LimbPose

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
