"""Soles: heel and toe tip of each foot, and their heights over the floor.

The skeleton ends a foot at the tip of its toes; the heel is added behind the ankle, as low as that tip when
the shin is upright.
"""

import numpy as np

from ..arrays import Array
from .extremities import RIGID, Extremities, segment_turn
from .kinematics import Body, Pose
from .posture import Posture
from .skeleton import SIDES, Segment

HEEL_BEHIND = 0.32
"""From the ankle, as a share of the length from ankle to tip: about a quarter of a foot lies behind the ankle
(Winter 2009, *Biomechanics and Motor Control of Human Movement*)."""


def sole_offsets(body: Body) -> Array:
    """(2, 2, 3) heel and tip of the left and the right foot from its ankle, in the foot's frame [m]."""
    feet = [_foot(body, side) for side in SIDES]
    return np.stack([_sole(body, foot) - body.local(foot.start) for foot in feet])


def sole_places(body: Body, pose: Pose, extremities: Extremities = RIGID) -> Array:
    """World positions (..., 2, 2, 3) of heel and tip of the left and the right foot [m].

    Args:
        body: The body.
        pose: Its poses.
        extremities: Its feet; by default rigid with the shins.
    """
    feet = []
    for foot in (_foot(body, side) for side in SIDES):
        places = _sole(body, foot)
        if foot.name in extremities.turns:
            start = body.local(foot.start)
            turn = segment_turn(body, pose, extremities, foot.name)
            ankle = pose.place(foot.joint, start)
            feet.append(np.stack([ankle + turn @ (place - start) for place in places], axis=-2))
        else:
            feet.append(np.stack([pose.place(foot.joint, place) for place in places], axis=-2))
    return np.stack(feet, axis=-3)


def _foot(body: Body, side: str) -> Segment:
    return next(segment for segment in body.skeleton.segments if segment.name == f"foot.{side}")


def _sole(body: Body, foot: Segment) -> Array:
    """(2, 3) heel and tip in the joint's frame, the foot rigid with its shin [m]."""
    ankle, tip = body.local(foot.start), body.local(foot.end)
    behind = HEEL_BEHIND * body.actor.segments_m[foot.name]
    return np.array([[tip[0], ankle[1] + behind, tip[2]], tip])


def sole_heights_m(body: Body, pose: Pose) -> Array:
    """(..., 2) height of the lowest point of the left and the right sole [m]."""
    return np.asarray(sole_places(body, pose)[..., 2].min(axis=-1))


def lower_sole_m(body: Body, posture: Posture) -> Array:
    """(...,) height of the lower sole [m]."""
    return np.asarray(sole_heights_m(body, body.pose(posture)).min(axis=-1))
