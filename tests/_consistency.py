"""Whether an estimate is as good as it says: its errors and innovations against its own covariances.

Reference: Bar-Shalom, Li, Kirubarajan (2001), *Estimation with Applications to Tracking and Navigation*,
section 5.4.
"""

import numpy as np
from keymark.core.arrays import Array
from numpy.typing import ArrayLike
from scipy.stats import chi2

SIGMAS_OF_95_PERCENT = 1.96


def normalized_squared(vector: Array, covariance: Array) -> float:
    """eᵀ P⁻¹ e: of estimation errors the NEES, of innovations the NIS, χ² where the covariance is right."""
    return float(vector @ np.linalg.solve(covariance, vector))


def verdict(values: ArrayLike, degrees_of_freedom: ArrayLike, probability: float) -> str:
    """Whether normalized squares (N,) with these degrees of freedom are "honest", "overconfident" or "timid".

    The sum of N independent values is χ² with the sum of their degrees of freedom.
    """
    sample = np.asarray(values, dtype=np.float64)
    total = float(np.broadcast_to(np.asarray(degrees_of_freedom, dtype=np.float64), sample.shape).sum())
    tail = 0.5 * (1.0 - probability)
    if sample.sum() < chi2.ppf(tail, total):
        return "timid"
    return "overconfident" if sample.sum() > chi2.ppf(1.0 - tail, total) else "honest"


def coverage(error: Array, sigma: Array) -> float:
    """Share of errors within the interval of 95 %."""
    return float(np.mean(error <= SIGMAS_OF_95_PERCENT * sigma))
