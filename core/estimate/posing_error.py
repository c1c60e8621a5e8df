"""How far keyframes are off, estimated from the footage at the keyframes.

A person who poses a skeleton over footage errs in joint angles and in place. The shape of that error is
assumed, its size is not: the size is chosen that makes the regions seen at the keyframes most likely
(empirical Bayes; Robbins 1956), between exact keyframes and careless ones.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body.skeleton import Skeleton

Array = NDArray[np.float64]

PLACE_STD_M = 0.010
TURN_STD_RAD = 0.055
SCALES = np.geomspace(0.1, 2.5, 25)
"""Sizes tried, relative to a person's usual error."""
SCALE_MEDIAN, SCALE_SPREAD = 0.7, 1.2
"""A log-normal belief in the size before the footage is seen."""


def posing_std(skeleton: Skeleton) -> Array:
    """(D,) a person's usual posing error for each degree of freedom [m, rad]."""
    std = np.full(skeleton.dof_count, TURN_STD_RAD)
    std[:3] = PLACE_STD_M
    return std


@dataclass(frozen=True, eq=False)
class KeyframeInnovation:
    """What the footage says against one keyframe's posture."""

    residual: Array
    """(m,) features, predicted minus observed [px]."""
    jacobian: Array
    """(m, D) by the posture's tangent."""
    variance: Array
    """(m,) of the features at the true posture [px²]."""


def estimate_posing_scale(skeleton: Skeleton, innovations: list[KeyframeInnovation]) -> float:
    """The most likely size of the posing error, relative to `posing_std`."""
    std = posing_std(skeleton)
    log_posterior = -0.5 * (np.log(SCALES / SCALE_MEDIAN) / SCALE_SPREAD) ** 2
    for item in innovations:
        spread = item.jacobian * std
        for i, scale in enumerate(SCALES):
            covariance = scale**2 * spread @ spread.T + np.diag(item.variance)
            factor = np.linalg.cholesky(covariance)
            white = np.linalg.solve(factor, item.residual)
            log_posterior[i] -= 0.5 * white @ white + np.log(np.diag(factor)).sum()
    return float(SCALES[np.argmax(log_posterior)])
