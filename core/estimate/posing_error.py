"""How far keyframes are off, estimated from the footage at the keyframes.

A person who poses a skeleton over footage puts every joint a little off, and the whole figure too; an
error upstream is made good downstream, so joints' places err independently, not their angles. The shape
of that error is assumed, its size is not: the size is chosen that makes the regions seen at the keyframes
most likely (empirical Bayes; Robbins 1956), between exact keyframes and careless ones.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Body, Pose

Array = NDArray[np.float64]

POINT_STD_M = 0.014
"""Error of each point along each axis [m]."""
PLACE_STD_M = 0.009
"""Error that all points share along each axis [m]."""
FREE_STD_RAD = 0.5
"""Error of what no point determines: rotations about a limb's own axis [rad]."""
SCALES = np.geomspace(0.1, 2.5, 25)
"""Sizes tried, relative to a person's usual error."""
SCALE_MEDIAN, SCALE_SPREAD = 0.7, 1.2
"""A log-normal belief in the size before the footage is seen."""


def posing_covariance(body: Body, pose: Pose) -> Array:
    """A person's usual posing error at given poses, as covariance (K, D, D) of the posture's tangent."""
    count = body.skeleton.dof_count
    jacobian = body.points_jacobian(pose).reshape(*pose.posture.batch, -1, count) / POINT_STD_M
    information = np.swapaxes(jacobian, -1, -2) @ jacobian + np.eye(count) * FREE_STD_RAD**-2
    covariance = np.linalg.solve(information, np.broadcast_to(np.eye(count), information.shape))
    place = np.arange(3)
    covariance[..., place, place] += PLACE_STD_M**2
    return np.asarray(0.5 * (covariance + np.swapaxes(covariance, -1, -2)))


@dataclass(frozen=True, eq=False)
class KeyframeInnovation:
    """What the footage says against one keyframe's posture."""

    residual: Array
    """(m,) features, predicted minus observed [px]."""
    jacobian: Array
    """(m, D) by the posture's tangent."""
    variance: Array
    """(m,) of the features at the true posture [px²]."""
    posing: Array
    """(D, D) covariance of a person's usual posing error there."""


def estimate_posing_scale(innovations: list[KeyframeInnovation]) -> float:
    """The most likely size of the posing error, relative to `posing_covariance`."""
    log_posterior = -0.5 * (np.log(SCALES / SCALE_MEDIAN) / SCALE_SPREAD) ** 2
    for item in innovations:
        spread = item.jacobian @ item.posing @ item.jacobian.T
        for i, scale in enumerate(SCALES):
            factor = np.linalg.cholesky(scale**2 * spread + np.diag(item.variance))
            white = np.linalg.solve(factor, item.residual)
            log_posterior[i] -= 0.5 * white @ white + np.log(np.diag(factor)).sum()
    return float(SCALES[np.argmax(log_posterior)])
