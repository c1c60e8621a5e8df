"""Marker styles: a marker's name, segment and color sample, and groups of markers that look alike."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .colors.color_learning import sample_distribution

ALIKE_DISTANCE = 2.5
"""Squared Mahalanobis distance of two samples below which light may make them equal."""


@dataclass(frozen=True)
class MarkerStyle:
    """A colored surface marker as the performer wears it."""

    name: str
    """The marker's name."""
    segment: str
    """The body segment it is bound to."""
    color_srgb: tuple[int, int, int]
    """One eyedropper sample of the footage, (red, green, blue) in 0..255."""


def color_groups(styles: Sequence[MarkerStyle]) -> list[list[int]]:
    """Group the indices of the markers by color; markers of indistinguishable colors are together."""
    groups: list[list[int]] = []
    for index, style in enumerate(styles):
        for group in groups:
            if any(_distance(style.color_srgb, styles[other].color_srgb) < ALIKE_DISTANCE for other in group):
                group.append(index)
                break
        else:
            groups.append([index])
    return groups


def _distance(first: tuple[int, int, int], second: tuple[int, int, int]) -> float:
    """Squared Mahalanobis distance of two samples, by the covariance of their difference."""
    one, other = sample_distribution(first), sample_distribution(second)
    offset = one.mean - other.mean
    squared = float(offset @ np.linalg.solve(one.covariance + other.covariance, offset))
    light = (one.log_luma - other.log_luma) ** 2
    return squared + light / (one.log_luma_deviation**2 + other.log_luma_deviation**2)
