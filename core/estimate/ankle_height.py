"""How high the lower ankle is over a clip, by what a matched library says of its performer's feet.

A library's postures know the floor: their lowest sole touches it but in flight. Ankles are told from it and
not from the library's own, which are lifted by feet that cannot bend.
"""

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.soles import sole_heights_m

TOUCHING_PERCENT = 30.0
"""In at least so many of the keyframes some sole is on the floor: more than half are, but for runners."""
SHOE_M = 0.012
"""Soles of shoes, and a heel that hardly ever lies wholly on the floor."""
FOOTING_STD_M = 0.03


def lower_ankle_m(body: Body, matched: Posture, index: IndexArray, frames: int) -> Array:
    """(F,) usual height of the lower ankle [m].

    Args:
        body: The actor's body.
        matched: K matched postures, as the library has them.
        index: (K,) their places in the clip, in order.
        frames: Frames of the clip, F.
    """
    soles = sole_heights_m(body, body.pose(matched)).min(axis=-1)
    floor = np.percentile(soles, TOUCHING_PERCENT)
    flight = np.interp(np.arange(frames), index, np.maximum(soles - floor, 0.0))
    rest = Posture.rest(body.skeleton)
    pose = body.pose(rest)
    ankle = body.points(pose)[body.skeleton.point_names.index("ankle.L"), 2]
    standing = float(ankle - sole_heights_m(body, pose).min()) + SHOE_M
    return np.asarray(floor + standing + flight)
