"""Soles: heel and toe tip of each foot, and their heights over the floor.

The skeleton ends a foot at the tip of its toes; the heel is added behind the ankle, as low as that tip when
the shin is upright.
"""

import numpy as np

from ..arrays import Array
from .kinematics import Body, Pose
from .posture import Posture
from .skeleton import SIDES

HEEL_BEHIND = 0.32
"""From the ankle, as a share of the length from ankle to tip: about a quarter of a foot lies behind the ankle
(Winter 2009, *Biomechanics and Motor Control of Human Movement*)."""


def sole_places(body: Body, pose: Pose) -> Array:
    """World positions (..., 2, 2, 3) of heel and tip of the left and the right foot [m]."""
    feet = []
    for side in SIDES:
        segment = next(segment for segment in body.skeleton.segments if segment.name == f"foot.{side}")
        ankle, tip = body.local(segment.start), body.local(segment.end)
        behind = HEEL_BEHIND * body.actor.segments_m[f"foot.{side}"]
        heel = np.array([tip[0], ankle[1] + behind, tip[2]])
        feet.append(np.stack([pose.place(segment.joint, place) for place in (heel, tip)], axis=-2))
    return np.stack(feet, axis=-3)


def sole_heights_m(body: Body, pose: Pose) -> Array:
    """(..., 2) height of the lowest point of the left and the right sole [m]."""
    return np.asarray(sole_places(body, pose)[..., 2].min(axis=-1))


def lower_sole_m(body: Body, posture: Posture) -> Array:
    """(...,) height of the lower sole [m]."""
    return np.asarray(sole_heights_m(body, body.pose(posture)).min(axis=-1))
