"""How a motion may depart from the prior between its keyframes: how fast, and which joints together.

Where neighboring keyframes differ much, much happens between them, and what happens between them is made of
the same movements: the hip that swings forward bends the knee. The departure's acceleration is therefore
given the size and, within each limb, the correlations of the steps between keyframes, beside a natural
amount that every joint has.
"""

import numpy as np

from ..arrays import Array
from ..body.posture import Posture

REFERENCE_STEP_S = 1.0 / 30.0
"""Accelerations are stated as second differences at this step."""
NATURAL_SHARE = 0.2
"""Of every degree of freedom's natural deviation (`Skeleton.deviations`)."""
TOGETHER_SHARE, ALONE_SHARE = 6.0, 2.5
"""Of the steps between keyframes over the square of the time they take, with and without correlations.

A swing there and back within a gap, a half sine, accelerates by nearly ten times its size over that square.
"""


def process_noise_factor(keyframes: Posture, time_s: Array) -> Array:
    """A square root L (D, D) of the covariance of the departure's second differences, L Lᵀ.

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
        covariance += ALONE_SHARE**2 * np.diag(np.diag(shared))
        for limb in skeleton.limbs:
            block = np.ix_(limb, limb)
            covariance[block] += TOGETHER_SHARE**2 * shared[block]
    return np.asarray(np.linalg.cholesky(covariance))
