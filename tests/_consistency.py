"""Whether an estimate is as good as it says: its errors and innovations against its own covariances.

Reference: Bar-Shalom, Li, Kirubarajan (2001), *Estimation with Applications to Tracking and Navigation*,
section 5.4.
"""

from typing import NamedTuple

import numpy as np
from keymark.core.arrays import Array
from numpy.typing import ArrayLike
from scipy.stats import chi2, t

SIGMAS_OF_95_PERCENT = 1.96


class Interval(NamedTuple):
    """An average and the interval it should lie, or the mean lies, in."""

    average: float
    """of the given values."""
    low: float
    """lower bound."""
    high: float
    """upper bound."""


def normalized_squared(vector: ArrayLike, covariance: ArrayLike) -> Array:
    """Squared length of vectors in units of their covariance, eᵀ P⁻¹ e: (...,).

    Of estimation errors it is the normalized estimation error squared (NEES), of innovations the normalized
    innovation squared (NIS); both are χ² with n degrees of freedom where the covariance is right.

    Args:
        vector: (..., n) errors, for postures `truth.minus(estimate)`.
        covariance: (..., n, n), positive definite.

    Raises:
        numpy.linalg.LinAlgError: a covariance is not positive definite.
    """
    factor = np.linalg.cholesky(np.asarray(covariance, dtype=np.float64))
    scaled = np.linalg.solve(factor, np.asarray(vector, dtype=np.float64)[..., None])[..., 0]
    return np.asarray(np.sum(scaled**2, axis=-1))


def chi_square_average(
    values: ArrayLike, degrees_of_freedom: ArrayLike, probability: float = 0.95
) -> Interval:
    """The average of N independent normalized squares, and where it lies if the covariances are right.

    Args:
        values: (N,) NIS or NEES values, of different runs, or of different frames for a NIS.
        degrees_of_freedom: of each value, (N,) or one for all.
        probability: of the interval; two-sided.

    Returns:
        Average and bounds: the sum of N values is χ² with the sum of their degrees of freedom. An average
        above `high` means that the estimate is too sure of itself, below `low` too timid.
    """
    sample = np.asarray(values, dtype=np.float64)
    total = float(np.broadcast_to(np.asarray(degrees_of_freedom, dtype=np.float64), sample.shape).sum())
    tail = 0.5 * (1.0 - probability)
    low, high = (float(chi2.ppf(share, total)) / sample.size for share in (tail, 1.0 - tail))
    return Interval(float(sample.mean()), low, high)


def coverage(error: ArrayLike, sigma: ArrayLike, sigmas: float = SIGMAS_OF_95_PERCENT) -> float:
    """Share of errors within `sigmas` standard deviations.

    Args:
        error: (...) lengths or signed components of errors.
        sigma: (...) their standard deviations; pairs with a NaN are left out.
        sigmas: half the width of the interval.

    Returns:
        Between 0 and 1; NaN where nothing can be compared. For an error's length against the square root of
        its covariance's trace, as motions are scored, honest estimates give 0.95 to 1.
    """
    length, deviation = np.broadcast_arrays(
        np.abs(np.asarray(error, dtype=np.float64)), np.asarray(sigma, dtype=np.float64)
    )
    known = np.isfinite(length) & np.isfinite(deviation)
    return float(np.mean(length[known] <= sigmas * deviation[known])) if known.any() else float("nan")


def mean_interval(values: ArrayLike, probability: float = 0.95) -> Interval:
    """The mean over independent runs with its confidence interval (Student's t).

    Args:
        values: (N,) one value a run.
        probability: of the interval.

    Raises:
        ValueError: fewer than two runs.
    """
    sample = np.asarray(values, dtype=np.float64)
    if sample.size < 2:
        raise ValueError(f"an interval needs at least 2 runs, not {sample.size}")
    average = float(sample.mean())
    error = float(sample.std(ddof=1)) / sample.size**0.5
    half = float(t.ppf(0.5 * (1.0 + probability), sample.size - 1)) * error
    return Interval(average, average - half, average + half)
