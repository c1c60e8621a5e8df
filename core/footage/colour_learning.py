"""Learning the markers' colours over a clip, from one sample each and a few of the clip's own frames."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from .colour_model import ColourDistribution, ColourModel, colour_model, weigh
from .colour_space import CELL_COUNT, CELLS_PER_CHANNEL, cell_colours, cell_index, chromaticity
from .working_image import smooth

FloatArray = NDArray[np.float64]
Image = NDArray[np.uint8]

# What one sample leaves open: saturation by 15 %, hue by 6 degrees, light by a factor of 1.6 either way.
_SATURATION_DEVIATION: Final = 0.15
_HUE_DEVIATION: Final = 0.10
_LOG_LUMA_DEVIATION: Final = 0.45
_LEAST_SATURATION: Final = 0.04
"""A grey has no hue to be off by: below this the deviations shrink no further."""

_STRONG: Final = 7.8  # squared distances: 95 % and 99.9 % of a chi-squared with 3 degrees of freedom
_FARTHEST: Final = 16.3
_NEAR: Final = 2.4  # half of it
_LEARNED_SHARE: Final = 0.7
"""Share of a marker's pixels, those nearest its sample, that its distribution is fitted to."""
_ROUNDS: Final = 3
_FEWEST_PIXELS: Final = 40
_LARGEST_SHARE: Final = 0.25
"""A region over a quarter of the image is a wall or a floor."""
_SMALLEST_LOG_LUMA_DEVIATION: Final = 0.3
_UNSEEN_SHARE: Final = 0.2
"""Share of the sample's own uncertainty that remains after learning."""
_STEEPEST_SLOPE: Final = 0.25
_BACKGROUND_MARGIN: Final = 3
_KERNEL: Final = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (3, 3))


@dataclass(frozen=True, eq=False)
class LearnedColours:
    """What the sampled frames teach.

    Attributes:
        model: the colour cells' labels, with the background weighed in.
        found: (M,) pixels found of each marker over the sampled frames; 0 where its colour matches nothing.
        background_counts: (CELL_COUNT,) background pixels per colour cell.
    """

    model: ColourModel
    found: NDArray[np.int64]
    background_counts: FloatArray


def learn_colours(
    images: Sequence[Image],
    samples_srgb: Sequence[tuple[int, int, int]],
    allowed: Sequence[NDArray[np.bool_] | None] | None = None,
) -> LearnedColours:
    """Learn each marker's distribution of colour and the background's colours.

    Regions near each sample's colour are found, the distribution is fitted to what they hold, and all that
    lies clear of them is counted as background; the next round finds the regions again by weighing the two,
    and so on.

    Args:
        images: sampled frames, (rows, columns, 3) uint8, on the searching grid.
        samples_srgb: one (red, green, blue) in 0..255 per marker.
        allowed: per image, (M, rows, columns) where each marker may be looked for, or None for everywhere.
    """
    sampled = _Sampled(images)
    initial = [sample_distribution(sample) for sample in samples_srgb]
    distributions = list(initial)
    labels = sampled.near(initial)
    for _ in range(_ROUNDS):
        regions = sampled.regions(labels, initial)
        # Clutter of a marker's very colour is kept out of the background too, or it would cost us the marker.
        background = sampled.background_counts(regions)
        masks = _marker_masks(regions, len(initial), allowed)
        found = np.array([sum(np.count_nonzero(mask) for mask in row) for row in masks])
        for marker, start in enumerate(initial):
            chroma, luma = sampled.colours([_interior(mask) for mask in masks[marker]])
            own = _near_sample(chroma, luma, start)
            if np.count_nonzero(own) >= _FEWEST_PIXELS:
                distributions[marker] = fit_distribution(chroma[own], luma[own], start)
        labels = sampled.weighed(distributions, np.maximum(found, 1), background)
    return LearnedColours(colour_model(distributions, np.maximum(found, 1), background), found, background)


def sample_distribution(sample_srgb: tuple[int, int, int]) -> ColourDistribution:
    """Return what one sample (red, green, blue) tells of a surface's colour before looking at the clip."""
    chroma, luma = chromaticity(np.asarray(sample_srgb, dtype=np.float64)[::-1])
    saturation = float(np.linalg.norm(chroma))
    radial = chroma / saturation if saturation > 0.0 else np.array([1.0, 0.0])
    tangential = np.array([-radial[1], radial[0]])
    extent = max(saturation, _LEAST_SATURATION)
    covariance = (_SATURATION_DEVIATION * extent) ** 2 * np.outer(radial, radial)
    covariance += (_HUE_DEVIATION * extent) ** 2 * np.outer(tangential, tangential)
    return ColourDistribution(float(np.log(luma)), _LOG_LUMA_DEVIATION, chroma, np.zeros(2), covariance)


def fit_distribution(chroma: FloatArray, luma: FloatArray, start: ColourDistribution) -> ColourDistribution:
    """Fit a distribution to a surface's pixels, robustly, and never narrower than pixel noise.

    Args:
        chroma: (N, 2) chromaticity.
        luma: (N,) offset luma in levels.
        start: the sample's own distribution; the fit's centre stays within its reach.
    """
    log_luma = np.log(luma)
    low, middle, high = np.quantile(log_luma, [0.1, 0.5, 0.9])
    deviation = max(float(high - low) / 2.563, _SMALLEST_LOG_LUMA_DEVIATION)
    light = log_luma - middle
    centre = np.median(chroma, axis=0)
    keep = np.sum((chroma - centre) ** 2, axis=1) <= np.quantile(np.sum((chroma - centre) ** 2, axis=1), 0.9)
    spread = float(light[keep] @ light[keep]) + len(luma) * 0.01  # ridge: even light has no slope to tell
    slope = np.clip(light[keep] @ (chroma[keep] - centre) / spread, -_STEEPEST_SLOPE, _STEEPEST_SLOPE)
    residual = (chroma - centre - np.outer(light, slope))[keep]
    # Of a normal distribution's variance in the plane the trimmed tenth takes a third.
    # Pixel noise is not added here but where distances are taken.
    covariance = 1.5 * residual.T @ residual / max(len(residual), 1)
    # The frames between the sampled ones show other light, folds and blur; the background limits what this
    # admits.
    covariance += _UNSEEN_SHARE * start.covariance
    fitted = replace(
        start,
        log_luma=float(middle),
        log_luma_deviation=deviation,
        mean=centre,
        slope=slope,
        covariance=covariance,
    )
    return fitted if _within_reach(fitted, start) else start


def _within_reach(fitted: ColourDistribution, start: ColourDistribution) -> bool:
    offset = fitted.mean - start.mean
    return float(offset @ np.linalg.solve(start.covariance, offset)) <= _FARTHEST


class _Sampled:
    """The sampled frames as indices into the table of the colours that occur in them."""

    def __init__(self, images: Sequence[Image]) -> None:
        cells = [cell_index(smooth(image)) for image in images]
        present = np.zeros(CELL_COUNT, dtype=np.bool_)
        for cell in cells:
            present[cell] = True
        self._table = np.flatnonzero(present).astype(np.int32)
        self._chroma, self._luma = chromaticity(cell_colours(self._table))
        rank = np.zeros(CELL_COUNT, dtype=np.int32)
        rank[self._table] = np.arange(len(self._table), dtype=np.int32)
        self._images = [rank[cell] for cell in cells]

    def near(self, distributions: Sequence[ColourDistribution]) -> NDArray[np.int64]:
        """Label each colour of the table by the distribution in whose core it lies; -1 for none."""
        pairs = [distribution.distance(self._chroma, self._luma) for distribution in distributions]
        nearest = np.argmax([density for _, density in pairs], axis=0)
        distance = np.array([squared for squared, _ in pairs])[nearest, np.arange(len(nearest))]
        return np.where(distance < _STRONG, nearest, -1)

    def weighed(
        self, distributions: Sequence[ColourDistribution], pixels: NDArray[np.int64], background: FloatArray
    ) -> NDArray[np.int64]:
        """Label each colour of the table by its likeliest marker; -1 where the background is likelier."""
        label, probability = weigh(distributions, pixels, background[self._table], self._chroma, self._luma)
        return np.where(probability >= 0.5, label, -1)

    def regions(
        self, labels: NDArray[np.int64], initial: Sequence[ColourDistribution]
    ) -> list[NDArray[np.int16]]:
        """Label each frame's connected regions with enough colours near a marker's sample; -1 elsewhere."""
        core = self.near(initial)
        result = []
        for image in self._images:
            label_image, core_image = labels[image], core[image]
            regions = np.full(image.shape, -1, dtype=np.int16)
            for marker in range(len(initial)):
                mask = label_image == marker
                regions[_with_core(mask, mask & (core_image == marker))] = marker
            result.append(regions)
        return result

    def colours(self, masks: Sequence[NDArray[np.bool_]]) -> tuple[FloatArray, FloatArray]:
        """Return chromaticity (N, 2) and offset luma (N,) of the masked pixels of all frames."""
        index = np.concatenate([image[mask] for image, mask in zip(self._images, masks, strict=True)])
        return self._chroma[index], self._luma[index]

    def background_counts(self, regions: Sequence[NDArray[np.int16]]) -> FloatArray:
        """Count the colours clear of all regions by cells, (CELL_COUNT,), spread over neighbouring cells."""
        counts = np.zeros(CELL_COUNT)
        for image, label in zip(self._images, regions, strict=True):
            near = cv2.dilate((label >= 0).astype(np.uint8), _KERNEL, iterations=_BACKGROUND_MARGIN)
            counts[self._table] += np.bincount(image[near == 0], minlength=len(self._table))
        cube = counts.reshape((CELLS_PER_CHANNEL,) * 3).astype(np.float32)
        spread = gaussian_filter(cube, sigma=1.0, mode="nearest", truncate=2.0)
        return np.asarray(spread.ravel(), dtype=np.float64)


def _marker_masks(
    regions: Sequence[NDArray[np.int16]], markers: int, allowed: Sequence[NDArray[np.bool_] | None] | None
) -> list[list[NDArray[np.bool_]]]:
    """Return each marker's pixels in each frame, where it may be looked for."""
    places = allowed if allowed is not None else [None] * len(regions)
    return [
        [
            image == marker if place is None else (image == marker) & place[marker]
            for image, place in zip(regions, places, strict=True)
        ]
        for marker in range(markers)
    ]


def _with_core(mask: NDArray[np.bool_], strong: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Keep connected regions of which enough is of the core colour and which are not most of the image."""
    count, components, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    core = np.bincount(components[strong], minlength=count)
    area = stats[:, cv2.CC_STAT_AREA]
    good = (core >= np.maximum(4, 0.25 * area)) & (area <= _LARGEST_SHARE * mask.size)
    good[0] = False
    return np.asarray(good[components])


def _near_sample(chroma: FloatArray, luma: FloatArray, start: ColourDistribution) -> NDArray[np.bool_]:
    """Mark the pixels (N,) to learn from.

    What lies far from the sample is a blend at a border, or skin and wood under warm light; learning from it
    would widen and move the distribution round by round.
    """
    distance, _ = start.distance(chroma, luma)
    if not len(distance):
        return np.zeros(0, dtype=np.bool_)
    return distance <= np.clip(np.quantile(distance, _LEARNED_SHARE), _NEAR, _FARTHEST)


def _interior(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the mask without its mixed border where that leaves enough of it."""
    inner = cv2.erode(mask.astype(np.uint8), _KERNEL).astype(np.bool_)
    return inner if np.count_nonzero(inner) >= 0.25 * np.count_nonzero(mask) else mask
