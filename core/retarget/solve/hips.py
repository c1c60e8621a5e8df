"""Hips: lowered where a leg cannot reach the foot that stands, or an arm the floor."""

import numpy as np

from ...arrays import Array, BoolArray
from .smoothing import smooth_above, smoothed
from .two_bone import STRAIGHTEST, LimbPose

LEG_SOFT = 0.988
"""Share of its length from which a leg resists being stretched."""
SINK_S = 0.12
"""Time over which the hips go down and up again."""
MOMENT_S = 0.07
"""Standard deviation in time of the smoothing of how far a limb may be stretched."""
DEEPEST_SHARE = 0.08
"""Deepest that they go, as a share of the legs' length."""


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
    allowed = np.maximum(soft, np.minimum(own, smoothed(own, time_s, MOMENT_S)))
    way = goal - limb.start
    aside = np.sum(way[:, :2] ** 2, axis=-1)
    below = np.sqrt(np.maximum((allowed * STRAIGHTEST * limb.length_m) ** 2 - aside, 0.0))
    return np.where(needed, np.maximum(-way[:, 2] - below, 0.0), 0.0)


def lowered_m(needed: list[Array], time_s: Array, leg_m: float) -> Array:
    """(F,) how much lower the hips go, smoothly, for what their limbs need [m]."""
    highest = np.minimum(np.maximum.reduce(needed), DEEPEST_SHARE * leg_m)
    return smooth_above(highest, time_s, SINK_S)
