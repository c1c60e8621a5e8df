"""Process noise of the deviation from the prior between keyframes: its size, and the joints' correlations.

Where neighboring keyframes differ much, much happens between them, and it is made of the same movements: the
hip that swings forward bends the knee. The deviation's acceleration therefore has the size and, within each
limb, the correlations of the steps between keyframes, plus a natural amount for every joint.
"""

import numpy as np

from ..arrays import Array
from ..body.posture import Posture

REFERENCE_STEP_S = 1.0 / 30.0
"""Accelerations are stated as second differences at this step."""
NATURAL_SHARE = 0.2
"""Factor on every degree of freedom's natural deviation (`Skeleton.deviations`)."""
CORRELATED_SHARE, INDEPENDENT_SHARE = 6.0, 2.5
"""Factors on the steps between keyframes over their squared duration, with and without correlations.

A swing there and back within a gap, a half sine, accelerates by nearly ten times its size over that square.
"""


def process_noise_factor(keyframes: Posture, time_s: Array) -> Array:
    """Cholesky factor L (D, D) of the covariance L Lᵀ of the deviation's second differences.

    Args:
        keyframes: K postures in order of time.
        time_s: (K,) their times.

    Returns:
        Lower triangular, zero between different limbs [m, rad per squared step of 1/30 s].
    """
    skeleton = keyframes.skeleton
    covariance = np.diag((NATURAL_SHARE * skeleton.deviations) ** 2)
    if len(time_s) > 1:
        gap = np.diff(time_s)[:, None] / REFERENCE_STEP_S
        step = keyframes[1:].minus(keyframes[:-1]) / gap**2
        shared = step.T @ step / len(step)
        covariance += INDEPENDENT_SHARE**2 * np.diag(np.diag(shared))
        for limb in skeleton.limbs:
            block = np.ix_(limb, limb)
            covariance[block] += CORRELATED_SHARE**2 * shared[block]
    return np.asarray(np.linalg.cholesky(covariance))
