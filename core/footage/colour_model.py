"""How a marker's colour is distributed over a clip, and which colour belongs to which marker or to none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .colour_space import cell_colours, cell_index, cell_volume, chromaticity

FloatArray = NDArray[np.float64]

NOISE_LEVELS: Final = 5.0
"""Standard deviation of a decoded, lightly smoothed colour difference in levels: sensor and compression."""
OUTLIER_DISTANCE: Final = 16.0
"""Squared distance past which no colour is a marker's, even one the background never shows: 99.9 % of χ²."""
BACKGROUND: Final = 255
"""Label of pixels that are no marker's."""


@dataclass(frozen=True, eq=False)
class ColourDistribution:
    """Colour of one surface under changing light: log luma is normal, and so is chromaticity given it.

    Chromaticity may drift with luma (tone mapping takes colour from bright pixels), so its mean is a line in
    it.

    Attributes:
        log_luma: mean logarithm of offset luma.
        log_luma_deviation: its standard deviation.
        mean: (2,) chromaticity at the mean luma.
        slope: (2,) change of chromaticity per unit of log luma.
        covariance: (2, 2) of the chromaticity, without the pixel noise of dark colours.
    """

    log_luma: float
    log_luma_deviation: float
    mean: FloatArray
    slope: FloatArray
    covariance: FloatArray

    def distance(self, chroma: FloatArray, luma: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the squared Mahalanobis distance and the log density of colours.

        Args:
            chroma: (..., 2) chromaticity.
            luma: (...) offset luma in levels, as `chromaticity` gives it.

        Returns:
            Squared distance (...), and natural logarithm of the density over (chromaticity, log luma), (...).
        """
        light = np.log(luma) - self.log_luma
        offset = chroma - self.mean - self.slope * light[..., None]
        noise = (NOISE_LEVELS / luma) ** 2
        first = self.covariance[0, 0] + noise
        second = self.covariance[1, 1] + noise
        cross = self.covariance[0, 1]
        determinant = first * second - cross**2
        x, y = offset[..., 0], offset[..., 1]
        squared = (second * x**2 - 2.0 * cross * x * y + first * y**2) / determinant
        squared += (light / self.log_luma_deviation) ** 2
        normaliser = 3.0 * np.log(2.0 * np.pi) + np.log(determinant) + 2.0 * np.log(self.log_luma_deviation)
        return squared, -0.5 * (squared + normaliser)


@dataclass(frozen=True, eq=False)
class ColourModel:
    """Which colours belong to which marker, learned for one clip.

    Attributes:
        distributions: one a marker.
        label: (CELL_COUNT,) uint8, index of the likeliest marker of each colour cell, BACKGROUND where it is
            none's.
        probability: (CELL_COUNT,) uint8, how surely in 1/255.
    """

    distributions: tuple[ColourDistribution, ...]
    label: NDArray[np.uint8]
    probability: NDArray[np.uint8]

    def classify(self, image: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
        """Return the label (...) and the probability in 1/255 (...) of every pixel of a (..., 3) image."""
        cells = cell_index(image)
        return np.take(self.label, cells), np.take(self.probability, cells)


def colour_model(
    distributions: Sequence[ColourDistribution], pixel_counts: ArrayLike, background_counts: ArrayLike
) -> ColourModel:
    """Weigh every colour cell between the markers, the background and the unknown.

    Args:
        distributions: the markers' colours.
        pixel_counts: (M,) pixels of each marker in the frames that the background was counted in.
        background_counts: (CELL_COUNT,) pixels of the background, smoothed over neighbouring cells.
    """
    chroma, luma = chromaticity(cell_colours())
    label, probability = weigh(distributions, pixel_counts, background_counts, chroma, luma)
    table = np.where(probability >= 0.5, label, BACKGROUND).astype(np.uint8)
    return ColourModel(tuple(distributions), table, np.round(255.0 * probability).astype(np.uint8))


def weigh(
    distributions: Sequence[ColourDistribution],
    pixel_counts: ArrayLike,
    background_counts: ArrayLike,
    chroma: FloatArray,
    luma: FloatArray,
) -> tuple[NDArray[np.intp], FloatArray]:
    """Return the likeliest marker of each of N colour cells, (N,), and its posterior probability, (N,).

    Args:
        distributions: the markers' colours.
        pixel_counts: (M,) pixels of each marker in the frames that the background was counted in.
        background_counts: (N,) background pixels in each cell.
        chroma: (N, 2) chromaticity of the cells' middles.
        luma: (N,) their offset luma in levels.
    """
    counts = np.asarray(pixel_counts, dtype=np.float64)
    volume = cell_volume(luma)
    evidence = np.empty((len(distributions), len(luma)))
    distance = np.empty_like(evidence)
    for marker, distribution in enumerate(distributions):
        distance[marker], log_density = distribution.distance(chroma, luma)
        evidence[marker] = counts[marker] * np.exp(log_density) * volume
    label = np.argmax(evidence, axis=0)
    columns = np.arange(len(luma))
    best = evidence[label, columns]
    # The unknown: as likely as the marker itself at the outlier distance, everywhere.
    with np.errstate(over="ignore", invalid="ignore"):
        unknown = best * np.exp(0.5 * (distance[label, columns] - OUTLIER_DISTANCE))
        total = evidence.sum(axis=0) + np.asarray(background_counts, dtype=np.float64) + unknown
        return label, np.nan_to_num(best / total)
