"""Hips: lowered where a leg cannot reach the foot that stands, or an arm the floor."""

import numpy as np

from ...arrays import Array, BoolArray
from .smoothing import smooth_above
from .two_bone import STRAIGHTEST

LEG_SOFT = 0.985
"""Share of its length from which a leg resists being stretched."""
SINK_S = 0.2
"""Time over which the hips go down and up again."""
DEEPEST_SHARE = 0.08
"""Deepest that they go, as a share of the legs' length."""


def needed_drop_m(
    start: Array, goal: Array, own_m: Array, length_m: float, needed: BoolArray, soft: float = LEG_SOFT
) -> Array:
    """(F,) how much lower a limb must begin to reach its goal [m].

    Args:
        start: (F, 3) hip or shoulder [m].
        goal: (F, 3) ankle or wrist [m].
        own_m: (F,) extension by the performer's directions [m].
        length_m: Length of the limb.
        needed: (F,) whether the goal must be reached.
        soft: Share of its length from which the limb resists.
    """
    allowed = np.maximum(soft, np.minimum(own_m / length_m, 1.0)) * STRAIGHTEST * length_m
    way = goal - start
    aside = np.sum(way[:, :2] ** 2, axis=-1)
    below = np.sqrt(np.maximum(allowed**2 - aside, 0.0))
    drop = -way[:, 2] - below
    return np.where(needed, np.maximum(drop, 0.0), 0.0)


def lowered_m(needed: list[Array], time_s: Array, leg_m: float) -> Array:
    """(F,) how much lower the hips go, smoothly, for what their limbs need [m]."""
    highest = np.minimum(np.maximum.reduce(needed), DEEPEST_SHARE * leg_m)
    return smooth_above(highest, time_s, SINK_S)
