"""The color model: Gaussian color distributions of the markers, and a Bayes classifier of color cells."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...arrays import Array, Image, IndexArray, SingleArray
from .color_space import (
    CELL_COUNT,
    CELL_WIDTH,
    CELLS_PER_CHANNEL,
    cell_chromaticity,
    cell_index,
    cell_volume,
    chromaticity,
)

ColorArray = Array | SingleArray

NOISE_LEVELS = 5.0
"""Standard deviation of a decoded, lightly smoothed color difference in levels: sensor and compression."""
OUTLIER_DISTANCE = 16.0
"""Squared distance past which no color is a marker's, even one that the background lacks: 99.9 % of χ²."""
GROUP_MARGIN = 2.0
"""Ratio of squared distances between a group's center and its cells, at most."""
BACKGROUND = 255
"""Label of pixels that are no marker's."""


@dataclass(frozen=True, eq=False)
class ColorDistribution:
    """Color of one surface under changing light: log luma is normal, and so is chromaticity given it.

    Chromaticity may drift with luma (tone mapping takes color from bright pixels), so its mean is a line in
    it.
    """

    log_luma: float
    """Mean logarithm of offset luma."""
    log_luma_deviation: float
    """Its standard deviation."""
    mean: Array
    """(2,) chromaticity at the mean luma."""
    slope: Array
    """(2,) change of chromaticity per unit of log luma."""
    covariance: Array
    """(2, 2) of the chromaticity, without the pixel noise of dark colors."""

    def distance(
        self, chroma: ColorArray, luma: ColorArray, noise_levels: float = NOISE_LEVELS
    ) -> tuple[Array, Array]:
        """The squared Mahalanobis distance and the log density of colors.

        Args:
            chroma: (..., 2) chromaticity.
            luma: (...) offset luma in levels, as `chromaticity` gives it.
            noise_levels: Standard deviation of a pixel's color difference in levels.

        Returns:
            Squared distance (...), and natural logarithm of the density over (chromaticity, log luma), (...).
        """
        light = np.log(luma) - self.log_luma
        noise = (noise_levels / luma) ** 2
        first = float(self.covariance[0, 0]) + noise
        second = float(self.covariance[1, 1]) + noise
        cross = float(self.covariance[0, 1])
        determinant = first * second - cross**2
        x = chroma[..., 0] - float(self.mean[0]) - float(self.slope[0]) * light
        y = chroma[..., 1] - float(self.mean[1]) - float(self.slope[1]) * light
        squared = (second * x * x - 2.0 * cross * x * y + first * y * y) / determinant
        squared += (light / self.log_luma_deviation) ** 2
        normalizer = 3.0 * np.log(2.0 * np.pi) + np.log(determinant) + 2.0 * np.log(self.log_luma_deviation)
        return squared, -0.5 * (squared + normalizer)

    def within_reach(self, chroma: ColorArray, luma: ColorArray) -> IndexArray:
        """Indices of all of N colors nearer than OUTLIER_DISTANCE, and of some beyond.

        A fast bound: no component of a distance exceeds the whole.
        """
        light = np.log(luma) - self.log_luma
        widest = OUTLIER_DISTANCE * (float(self.covariance[0, 0]) + (NOISE_LEVELS / luma) ** 2)
        offset = chroma[..., 0] - float(self.mean[0]) - float(self.slope[0]) * light
        limit = float(np.sqrt(OUTLIER_DISTANCE)) * self.log_luma_deviation
        return np.flatnonzero((offset * offset <= widest) & (np.abs(light) <= limit))


@dataclass(frozen=True, eq=False)
class ColorModel:
    """Classifier of colors as markers or background, learned for one clip."""

    distributions: tuple[ColorDistribution, ...]
    """One a color."""
    label: Image
    """(CELL_COUNT,) uint8, index of the likeliest color of each cell, or BACKGROUND."""
    probability: Image
    """(CELL_COUNT,) uint8, posterior probability in 1/255."""

    def classify(self, image: Image) -> tuple[Image, Image]:
        """Label and probability in 1/255, (rows, columns), of every pixel of an image."""
        cells = cell_index(image)
        return np.take(self.label, cells), np.take(self.probability, cells)

    def labels(self, image: Image) -> Image:
        """The label, (rows, columns), of every pixel of an image."""
        return np.take(self.label, cell_index(image))


def color_model(
    distributions: Sequence[ColorDistribution], pixel_counts: ArrayLike, background_counts: ArrayLike
) -> ColorModel:
    """Classify every color cell as a marker's, the background's or unknown, by posterior probability.

    Args:
        distributions: The markers' colors.
        pixel_counts: (M,) pixels of each marker in the frames that the background was counted in.
        background_counts: (CELL_COUNT,) pixels of the background, smoothed over neighboring cells.
    """
    near = _cells_near(distributions)
    chroma, luma = cell_chromaticity(near)
    counts = np.asarray(background_counts, dtype=np.float64)[near]
    likeliest, sureness = weigh(distributions, pixel_counts, counts, chroma, luma)
    label = np.full(CELL_COUNT, BACKGROUND, dtype=np.uint8)
    probability = np.zeros(CELL_COUNT, dtype=np.uint8)
    label[near] = np.where(sureness >= 0.5, likeliest, BACKGROUND)
    probability[near] = np.round(255.0 * sureness)
    return ColorModel(tuple(distributions), label, probability)


def _cells_near(distributions: Sequence[ColorDistribution]) -> NDArray[np.int32]:
    """Cells, ascending, near any of the distributions.

    Tested by groups of two by two by two cells, within which colors change little.
    """
    side = CELLS_PER_CHANNEL // 2
    group = np.arange(side**3, dtype=np.int32)
    levels = np.stack([group % side, group // side % side, group // side**2], axis=-1)
    chroma, luma = chromaticity(levels * (2.0 * CELL_WIDTH) + (2 * CELL_WIDTH - 1) / 2.0)
    chroma, luma = chroma.astype(np.float32), luma.astype(np.float32)
    near = np.zeros((side, side, side), dtype=np.bool_)
    for distribution in distributions:
        near |= (distribution.distance(chroma, luma)[0] < GROUP_MARGIN * OUTLIER_DISTANCE).reshape(near.shape)
    cells = near.repeat(2, axis=0).repeat(2, axis=1).repeat(2, axis=2)
    return np.flatnonzero(cells).astype(np.int32)


def weigh(
    distributions: Sequence[ColorDistribution],
    pixel_counts: ArrayLike,
    background_counts: ArrayLike,
    chroma: ColorArray,
    luma: ColorArray,
) -> tuple[IndexArray, Array]:
    """The likeliest marker of each of N color cells, (N,), and its posterior probability, (N,).

    Args:
        distributions: The markers' colors.
        pixel_counts: (M,) pixels of each marker in the frames that the background was counted in.
        background_counts: (N,) background pixels in each cell.
        chroma: (N, 2) chromaticity of the cells' middles.
        luma: (N,) their offset luma in levels.
    """
    counts = np.asarray(pixel_counts, dtype=np.float64)
    best, total = np.zeros(len(luma)), np.asarray(background_counts, dtype=np.float64).copy()
    label, distance = np.zeros(len(luma), dtype=np.intp), np.full(len(luma), np.inf)
    for marker, distribution in enumerate(distributions):
        near = distribution.within_reach(chroma, luma)
        squared, log_density = distribution.distance(chroma.take(near, axis=0), luma.take(near))
        evidence = counts[marker] * np.exp(log_density) * cell_volume(luma[near])
        total[near] += evidence
        better = evidence > best[near]
        where = near[better]
        best[where], label[where], distance[where] = evidence[better], marker, squared[better]
    # The unknown: as likely as the marker itself at the outlier distance, everywhere.
    with np.errstate(over="ignore", invalid="ignore"):
        unknown = best * np.exp(0.5 * (distance - OUTLIER_DISTANCE))
        return label, np.nan_to_num(best / (total + unknown))
