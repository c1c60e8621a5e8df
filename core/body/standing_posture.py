"""The default posture: standing upright, arms hanging, facing -Y; and the heights that follow from it."""

import numpy as np

from ..arrays import Array
from .body_volume import HEAD_OVERSHOOT
from .kinematics import Body
from .posture import Posture
from .skeleton import SIDES

ARMS_LOWERED_RAD = float(np.radians(75.0))
"""From the T pose; less than a right angle, as sleeves keep the arms off the trunk."""
ELBOWS_BENT_RAD = np.radians(10.0)


def standing_posture(
    body: Body,
    place: Array | None = None,
    heading_rad: float = 0.0,
    arms_lowered_rad: float = ARMS_LOWERED_RAD,
) -> Posture:
    """A posture that stands upright on the ground.

    Args:
        body: The actor's body; its skeleton must be the default human one.
        place: (3,) point on the ground between the feet [m]; the world's origin by default.
        heading_rad: Turn about the world's Z from facing -Y.
        arms_lowered_rad: Angle of the arms below the horizontal.
    """
    skeleton = body.skeleton
    column = {name: i for i, name in enumerate(skeleton.dof_names)}
    vector = np.zeros(skeleton.dof_count)
    for side, out in zip(SIDES, (1.0, -1.0), strict=True):
        vector[column[f"shoulder.{side}.rotation_y"]] = out * arms_lowered_rad
        vector[column[f"elbow.{side}.flexion"]] = ELBOWS_BENT_RAD
    vector[column["pelvis.rotation_z"]] = heading_rad
    vector[:3] = np.zeros(3) if place is None else place
    vector[2] += hip_height_m(body)
    return Posture.from_vector(skeleton, vector)


def hip_height_m(body: Body) -> float:
    """Height of the hips' midpoint above the soles of a body that stands upright [m]."""
    pose = body.pose(Posture.rest(body.skeleton))
    ends = [body.segment_ends(pose, segment.name)[1] for segment in body.skeleton.segments]
    return -float(np.min(np.stack(ends)[:, 2]))


def standing_height_m(body: Body) -> float:
    """Height from the soles to the crown of a body that stands upright [m]."""
    lengths = body.actor.segments_m
    return hip_height_m(body) + lengths["trunk"] + HEAD_OVERSHOOT * lengths["neck_head"]
