"""Hips: lowered where a leg cannot reach the foot that stands, or an arm the floor."""

import numpy as np

from ...arrays import Array, BoolArray
from .smoothing import smooth_above
from .two_bone import STRAIGHTEST, LimbPose

LEG_SOFT = 0.985
"""Share of its length from which a leg resists being stretched."""
SINK_S = 0.2
"""Time over which the hips go down and up again."""
DEEPEST_SHARE = 0.08
"""Deepest that they go, as a share of the legs' length."""


def needed_drop_m(limb: LimbPose, goal: Array, needed: BoolArray, soft: float) -> Array:
    """(F,) how much lower a limb must begin to reach its goal [m].

    Args:
        limb: The limb by the performer's directions.
        goal: (F, 3) ankle or wrist [m].
        needed: (F,) whether the goal must be reached.
        soft: Share of its length from which the limb resists.
    """
    allowed = np.maximum(soft, np.minimum(limb.extension_m / limb.length_m, 1.0))
    way = goal - limb.start
    aside = np.sum(way[:, :2] ** 2, axis=-1)
    below = np.sqrt(np.maximum((allowed * STRAIGHTEST * limb.length_m) ** 2 - aside, 0.0))
    return np.where(needed, np.maximum(-way[:, 2] - below, 0.0), 0.0)


def lowered_m(needed: list[Array], time_s: Array, leg_m: float) -> Array:
    """(F,) how much lower the hips go, smoothly, for what their limbs need [m]."""
    highest = np.minimum(np.maximum.reduce(needed), DEEPEST_SHARE * leg_m)
    return smooth_above(highest, time_s, SINK_S)
