"""Height of the lower ankle over a clip, from the soles of matched postures.

The lowest sole of a library's posture touches the floor except in flight. Ankles are derived from the floor
and not from the library's own ankles, which are raised by feet that cannot bend.
"""

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..body.soles import sole_heights_m

TOUCHING_PERCENT = 30.0
"""Percentile of the lowest soles that is the floor: more than half touch it, except for runners."""
SHOE_M = 0.012
"""Thickness of a shoe's sole, and of a heel that hardly ever lies wholly on the floor."""
ANKLE_HEIGHT_STD_M = 0.03
SAME_FLOOR_M = 0.12
"""Ankles that stand within this of a given floor stand on it."""


def lower_ankle_m(body: Body, matched: Posture, index: IndexArray, frames: int) -> Array:
    """(F,) usual height of the lower ankle [m].

    Args:
        body: The actor's body.
        matched: K matched postures, as the library has them.
        index: (K,) their indices in the clip, in order.
        frames: Frames of the clip, F.
    """
    soles = sole_heights_m(body, body.pose(matched)).min(axis=-1)
    floor = np.percentile(soles, TOUCHING_PERCENT)
    flight = np.interp(np.arange(frames), index, np.maximum(soles - floor, 0.0))
    return np.asarray(floor + standing_ankle_m(body) + flight)


def standing_ankle_m(body: Body) -> float:
    """Height of the ankles of someone who stands in shoes [m]."""
    pose = body.pose(Posture.rest(body.skeleton))
    ankle = body.points(pose)[body.skeleton.point_names.index("ankle.L"), 2]
    return float(ankle - sole_heights_m(body, pose).min()) + SHOE_M


def found_ankle_m(
    body: Body, found: Posture, index: IndexArray, frames: int, floor_m: float | None = None
) -> Array:
    """(F,) height of the lower ankle [m] in postures whose ankles are where the footage has them.

    Their rigid feet may point into the floor, so that their soles tell nothing of it.

    Args:
        body: The actor's body.
        found: K postures put together from parts and held against the footage.
        index: (K,) their indices in the clip, in order.
        frames: Frames of the clip, F.
        floor_m: Height of the floor; by the ankles themselves where None.
    """
    points = body.points(body.pose(found))
    ankles = [body.skeleton.point_names.index(f"ankle.{side}") for side in SIDES]
    lower = points[:, ankles, 2].min(axis=-1)
    standing = float(np.percentile(lower, TOUCHING_PERCENT))
    if floor_m is not None and abs(standing - floor_m - standing_ankle_m(body)) < SAME_FLOOR_M:
        standing = floor_m + standing_ankle_m(body)
    return np.asarray(standing + np.interp(np.arange(frames), index, np.maximum(lower - standing, 0.0)))
