"""d(θ): camera depths of the principal points (paper, section 4, eq. 9).

The image does not measure depth, so the depths of the a priori posture serve as pseudo-measurements, with a
noise wide enough to yield to everything else.
"""

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, IndexArray
from ..body.kinematics import Body, Pose
from ..footage.camera import Camera

DEPTH_VARIANCE_M2 = 0.1
"""Variance of each depth's noise v_d [m²]: the paper's 10⁵ mm²."""
DEPTH_STD_M = DEPTH_VARIANCE_M2**0.5


def evaluate(body: Body, camera: Camera, pose: Pose, frame: ArrayLike | None = None) -> Array:
    """Depths of the principal points along the viewing axis (paper, eq. 9).

    Args:
        body: The actor's body.
        camera: The camera.
        pose: The body's pose, of any batch shape.
        frame: Index of each pose's camera, integers of the batch shape; a fixed camera ignores it.

    Returns:
        (..., P) [m], positive in front of the camera.
    """
    return camera.depth(body.points(pose), _per_point(frame))


def jacobian(body: Body, camera: Camera, pose: Pose, frame: ArrayLike | None = None) -> Array:
    """Derivative of the depths by the posture's tangent step, (..., P, D); arguments as `evaluate`."""
    points = body.points(pose)
    axis = camera.depth_jacobian(points, _per_point(frame))  # (..., P, 3)
    return pose.along_jacobian([point.joint for point in body.skeleton.points], points, axis)


def _per_point(frame: ArrayLike | None) -> IndexArray | None:
    return None if frame is None else np.asarray(frame, dtype=np.intp)[..., None]
