"""Height of the lower ankle over a clip, from the soles of matched postures.

The lowest sole of a library's posture touches the floor except in flight. Ankles are derived from the floor
and not from the library's own ankles, which are raised by feet that cannot bend.
"""

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.soles import sole_heights_m

TOUCHING_PERCENT = 30.0
"""Percentile of the lowest soles that is the floor: more than half touch it, except for runners."""
SHOE_M = 0.012
"""Thickness of a shoe's sole, and of a heel that hardly ever lies wholly on the floor."""
ANKLE_HEIGHT_STD_M = 0.03


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
    """Height of the ankles of someone who stands over the floor, in shoes [m]."""
    pose = body.pose(Posture.rest(body.skeleton))
    ankle = body.points(pose)[body.skeleton.point_names.index("ankle.L"), 2]
    return float(ankle - sole_heights_m(body, pose).min()) + SHOE_M
