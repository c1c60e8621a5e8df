"""Scales of the noise per marker and keypoint: how far a performer differs from a library in a whole clip."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, SingleArray
from ..numerics.robust import multivariate_cost, multivariate_weight
from .match_evidence import MatchEvidence

DEGREES_OF_FREEDOM = 4.0
"""Of Student's t distribution."""
SMALLEST_SCALE, LARGEST_SCALE = 0.6, 6.0
"""Bounds of the scales."""
PRIOR_FRAMES = 4.0
"""A scale of 1 is believed as firmly as this many independent frames tell."""
ITERATIONS = 12


@dataclass(frozen=True, eq=False)
class NoiseScales:
    """Scales of the standard deviations of A points, M of them markers and K keypoints."""

    centroid: Array
    """(A,) scale of each place's standard deviation: large for an arm that waves."""
    extent: Array
    """(M,) scale of each extent's standard deviation."""
    size: Array
    """(M,) size of each marker relative to an average body's."""
    depth: Array
    """(K,) scale of the standard deviation of each keypoint's guessed depth."""

    @classmethod
    def of(cls, evidence: MatchEvidence) -> "NoiseScales":
        """Scales of 1, for a performer of whom nothing is known yet."""
        markers, keypoints = evidence.marker_count, len(evidence.points)
        return cls(np.ones(markers + keypoints), np.ones(markers), np.ones(markers), np.ones(keypoints))


def student_cost(squared: SingleArray, dimensions: int) -> SingleArray:
    """Negative log likelihood under Student's t of squared distances, up to a constant."""
    return multivariate_cost(squared, DEGREES_OF_FREEDOM, dimensions)


def student_scales(residual: Array, visible: BoolArray, tempering: float) -> Array:
    """(M,) scales of standard deviations that explain residuals, by Student's t.

    Args:
        residual: (T, M, K) in unscaled standard deviations.
        visible: (T, M) which of them count.
        tempering: Weight of one frame.
    """
    squared = (residual**2).sum(axis=-1)
    dimensions = residual.shape[-1]
    scales = np.ones(residual.shape[1])
    frames = tempering * visible.sum(axis=0)
    for _ in range(ITERATIONS):
        weight = multivariate_weight(squared / scales**2, DEGREES_OF_FREEDOM, dimensions)
        total = tempering * np.where(visible, weight * squared, 0.0).sum(axis=0) / dimensions
        scales = np.sqrt((total + PRIOR_FRAMES) / (frames + PRIOR_FRAMES))
    return np.clip(scales, SMALLEST_SCALE, LARGEST_SCALE)
