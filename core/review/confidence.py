"""Confidence in each frame of a motion, one number from 0 to 1.

Confidence is the share of the principal points that are expected to lie within a tolerance of their true
places: the mean over the points of the probability that a normal error is shorter than the tolerance. The
error's covariance is the estimate's own, in which hidden markers and far keyframes show already, with two
additions:

* Where the footage moved a point far from the interpolated keyframes, these tell little there, and the error
  in what the footage cannot see, depth above all, is a share of that movement. The estimate's covariance
  does not grow with it; true errors do.
* Where most of the evidence (markers, keypoints, contours) contradicts the motion by more than it should, the
  covariance is scaled up by the Birge ratio (1932, *The calculation of errors by the method of least
  squares*).
"""

import numpy as np
from scipy.special import gammainc

from ..arrays import Array

TOLERANCE_SHARE = 0.025  # of the performer's stature: four to five centimeters for an adult


def expected_covariance(point_covariance: Array, moved_m: Array, misfit: Array) -> Array:
    """Expected covariance (F, P, 3, 3) of the points' errors [m²].

    Args:
        point_covariance: (F, P, 3, 3) the estimate's own [m²]; NaN where unknown.
        moved_m: (F, P) distance of each point from the interpolated keyframes [m].
        misfit: (F, E) of every piece of evidence, as `misfits` gives it of markers; NaN where not compared.
    """
    # Error in what is not seen, as a share of the distance that the footage moved a point: about the value
    # that takes with truth have with few keyframes.
    unseen = np.eye(3) * (0.2 * moved_m)[..., None, None] ** 2 / 3.0
    # The Birge ratio of what is compared, at least one; of the median evidence, since an outlier has lost its
    # weight in the estimate already.
    ratio, compared = np.ones(len(misfit)), np.isfinite(misfit).any(axis=1)
    ratio[compared] = np.maximum(np.nanmedian(misfit[compared], axis=1), 1.0)
    return np.asarray((point_covariance + unseen) * ratio[:, None, None, None])


def confidence(covariance: Array, tolerance_m: float) -> Array:
    """Share of the points (F,) expected within a tolerance [m], given `expected_covariance` (F, P, 3, 3).

    NaN where the covariance is. The squared length of a normal error is a weighted sum of χ²; the gamma
    distribution of its mean and variance stands in for it (Satterthwaite 1946, *An approximate distribution
    of estimates of variance components*), exactly so where it is alike in one, two or three directions.
    """
    mean = np.trace(covariance, axis1=-2, axis2=-1)
    half_variance = np.einsum("...ij,...ji->...", covariance, covariance)
    shape = mean**2 / np.maximum(2.0 * half_variance, 1e-30)
    scale = np.maximum(2.0 * half_variance / np.maximum(mean, 1e-30), 1e-30)
    return np.asarray(gammainc(shape, tolerance_m**2 / scale).mean(axis=1))


def misfits(distance_px: Array, expected_px: Array) -> Array:
    """Reduced squared distances (F, M): 1 on average where the noise is as assumed; NaN where not compared.

    `expected_px` is the standard deviation of each of a centroid's two coordinates.
    """
    return np.asarray((distance_px / expected_px) ** 2 / 2)
