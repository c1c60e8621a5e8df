"""Shape of postures, independent of location and heading, for comparing them; and heights of the ankles."""

import numpy as np

from ..arrays import Array
from ..body.heading import headings_rad, yaw_rotation
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES

ANKLE_OVER_SOLE = 0.36
"""Height of an ankle over flat soles, as a share of the foot's length; as in the standing skeleton."""


def shape_vectors(body: Body, posture: Posture) -> Array:
    """Shape vectors (F, 3 P); their distance is the root mean square distance of the points [m].

    They are the principal points relative to the ground below the hips, the performer facing -Y.
    """
    points = body.points(body.pose(posture))
    ground = posture.translation * [1.0, 1.0, 0.0]
    turn = yaw_rotation(-headings_rad(posture))
    seen = (points - ground[..., None, :]) @ np.swapaxes(turn, -1, -2)
    return np.asarray(seen.reshape(*posture.batch, -1) / np.sqrt(points.shape[-2]))


def ankle_heights(body: Body, posture: Posture) -> Array:
    """Heights (F, 2) of the left and the right ankle over those of feet flat on z = 0 [m].

    Ankles tell the floor's height, as soles do not: the skeleton's feet, rigid with the shins, point into the
    floor at the end of a step.
    """
    points = body.points(body.pose(posture))
    ankles = [body.skeleton.point_names.index(f"ankle.{side}") for side in SIDES]
    below = [ANKLE_OVER_SOLE * body.actor.segments_m[f"foot.{side}"] for side in SIDES]
    return np.asarray(points[..., ankles, 2] - below)
