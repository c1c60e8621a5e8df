"""Postures as they are compared: their shape, whatever place and heading they have, and these."""

import numpy as np

from ..arrays import Array
from ..body.heading import headings_rad, yaw_rotation
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES

ANKLE_OVER_SOLE = 0.36
"""Of the foot's length: as in the skeleton, whose feet's tips are on the floor when it stands."""


def shape_vectors(body: Body, posture: Posture) -> Array:
    """The bodies' shapes (F, 3 P), as vectors whose distance is the points' mean square distance's root [m].

    They are the points over the ground below the hips, the performer facing -Y.
    """
    points = body.points(body.pose(posture))
    ground = posture.translation * [1.0, 1.0, 0.0]
    turn = yaw_rotation(-headings_rad(posture))
    seen = (points - ground[..., None, :]) @ np.swapaxes(turn, -1, -2)
    return np.asarray(seen.reshape(*posture.batch, -1) / np.sqrt(points.shape[-2]))


def ankle_heights(body: Body, posture: Posture) -> Array:
    """How far (F, 2) the left and the right ankle lie above where those of feet flat on z = 0 lie [m].

    That tells where the floor is, as soles do not: the skeleton's feet, rigid with the shins, point into the
    floor at the end of a step.
    """
    points = body.points(body.pose(posture))
    ankles = [body.skeleton.point_names.index(f"ankle.{side}") for side in SIDES]
    below = [ANKLE_OVER_SOLE * body.actor.segments_m[f"foot.{side}"] for side in SIDES]
    return np.asarray(points[..., ankles, 2] - below)
