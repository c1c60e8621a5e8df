"""The measurement update of a Kalman filter, for rows scaled by their standard deviations.

Reference: Bar-Shalom, Li, Kirubarajan (2001), *Estimation with Applications to Tracking and Navigation*:
section 5.2.6 for Joseph's form, 5.4 for the normalized innovation squared.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ..arrays import Array


class Update(NamedTuple):
    """Update of a state by measurements."""

    step: Array
    """(D,) change of the mean."""
    covariance: Array
    """(D, D) after the update, symmetric."""
    normalized_innovation_squared: float
    """νᵀ S⁻¹ ν; χ² with m degrees of freedom if model and noise are right."""


def update(covariance: Array, measurement_matrix: Array, innovation: Array) -> Update:
    """Kalman gain and update (paper, eqs. 14 to 17), for noise of covariance 1.

    The paper scales its observations with their standard deviations too, so R is the identity. Joseph's form
    keeps the covariance symmetric and positive where rounding would not.

    Args:
        covariance: M (D, D), before the update.
        measurement_matrix: H (m, D), each row divided by its standard deviation; m may be 0.
        innovation: ν (m,), observed - predicted, likewise divided.
    """
    M, H = covariance, measurement_matrix
    if not len(H):
        return Update(np.zeros(len(M)), M, 0.0)
    MHt = M @ H.T
    factor = cho_factor(H @ MHt + np.eye(len(H)), lower=True)
    K = cho_solve(factor, MHt.T).T
    rest = np.eye(len(M)) - K @ H
    P = rest @ M @ rest.T + K @ K.T
    nis = float(innovation @ cho_solve(factor, innovation))
    return Update(K @ innovation, 0.5 * (P + P.T), nis)


def normalized_innovation_squared(covariance: Array, measurement_matrix: Array, innovation: Array) -> float:
    """νᵀ S⁻¹ ν of some rows alone, for gating; arguments as `update`."""
    S = measurement_matrix @ covariance @ measurement_matrix.T + np.eye(len(innovation))
    return float(innovation @ cho_solve(cho_factor(S, lower=True), innovation))
