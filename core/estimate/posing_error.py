"""Posing error of keyframes: the shape of its covariance; its size is found from the footage.

A person who poses a skeleton over footage puts every joint a little off, and the whole figure too; an
error upstream is made good downstream, so joints' places err independently, not their angles. And the
posture may be that of a moment before or after the frame it was set at. These shapes are assumed, their
sizes are not.
"""

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body, Pose
from ..body.posture import Posture

POINT_STD_M = 0.014
"""Error of each point along each axis [m]."""
PLACE_STD_M = 0.009
"""Error that all points share along each axis [m]."""
FREE_STD_RAD = 0.5
"""Error of rotations that no point determines, about a limb's own axis [rad]."""


def posing_covariance(body: Body, pose: Pose) -> Array:
    """A person's usual posing error at given poses, as covariance (K, D, D) of the posture's tangent."""
    count = body.skeleton.dof_count
    jacobian = body.points_jacobian(pose).reshape(*pose.posture.batch, -1, count) / POINT_STD_M
    information = np.swapaxes(jacobian, -1, -2) @ jacobian + np.eye(count) * FREE_STD_RAD**-2
    covariance = np.linalg.solve(information, np.broadcast_to(np.eye(count), information.shape))
    place = np.arange(3)
    covariance[..., place, place] += PLACE_STD_M**2
    return np.asarray(0.5 * (covariance + np.swapaxes(covariance, -1, -2)))


def velocities(keyframes: Posture, frame: IndexArray) -> Array:
    """Velocities of K keyframes' postures, (K, D) of the tangent per frame: of the parabola through three."""
    if len(frame) < 2:
        return np.zeros((len(frame), keyframes.skeleton.dof_count))
    gap = np.diff(frame)[:, None].astype(np.float64)
    after = keyframes[1:].minus(keyframes[:-1]) / gap
    velocity = np.concatenate([after, -keyframes[-2:-1].minus(keyframes[-1:]) / gap[-1:]])
    before = -keyframes[:-2].minus(keyframes[1:-1]) / gap[:-1]
    velocity[1:-1] = (gap[1:] * before + gap[:-1] * after[1:]) / (gap[1:] + gap[:-1])
    return velocity
