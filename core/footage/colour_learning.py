"""Learning the markers' colours over a clip, from one sample each and a few of the clip's own frames."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from .colour_model import NOISE_LEVELS, ColourDistribution, ColourModel, colour_model
from .colour_space import CELL_COUNT, CELLS_PER_CHANNEL, cell_index, chromaticity
from .working_image import smooth

FloatArray = NDArray[np.float64]
Image = NDArray[np.uint8]

# What one sample leaves open: saturation by 15 %, hue by 6 degrees, light by a factor of 1.6 either way.
_SATURATION_DEVIATION: Final = 0.15
_HUE_DEVIATION: Final = 0.10
_LOG_LUMA_DEVIATION: Final = 0.45

_STRONG: Final = 7.8  # squared distances: 95 % and 99.9 % of a chi-squared with 3 degrees of freedom
_WEAK: Final = 16.3
_ROUNDS: Final = 4
_FEWEST_PIXELS: Final = 40
_LARGEST_SHARE: Final = 0.25
"""A region over a quarter of the image is a wall or a floor."""
_SMALLEST_LOG_LUMA_DEVIATION: Final = 0.15
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

    Regions about each sample's colour are grown over connected pixels of like chromaticity, the distribution is
    fitted anew to what they hold, and so on a few rounds; all that lies clear of the regions is background.

    Args:
        images: sampled frames, (rows, columns, 3) uint8, on the working grid.
        samples_srgb: one (red, green, blue) in 0..255 per marker.
        allowed: per image, (M, rows, columns) where each marker may be looked for, or None for everywhere.
    """
    smoothed = [smooth(image) for image in images]
    where = allowed if allowed is not None else [None] * len(smoothed)
    initial = [sample_distribution(sample) for sample in samples_srgb]
    distributions = list(initial)
    found = np.zeros(len(initial), dtype=np.int64)
    for _ in range(_ROUNDS):
        regions = [_grow(image, distributions, place) for image, place in zip(smoothed, where, strict=True)]
        for marker, start in enumerate(initial):
            pixels = np.concatenate(
                [image[_interior(label == marker)] for image, label in zip(smoothed, regions, strict=True)]
            )
            found[marker] = sum(int(np.count_nonzero(label == marker)) for label in regions)
            if len(pixels) >= _FEWEST_PIXELS:
                distributions[marker] = fit_distribution(pixels, start)
    regions = [_grow(image, distributions, place) for image, place in zip(smoothed, where, strict=True)]
    background = _background_counts(smoothed, regions)
    return LearnedColours(colour_model(distributions, np.maximum(found, 1), background), found, background)


def sample_distribution(sample_srgb: tuple[int, int, int]) -> ColourDistribution:
    """Return what one eyedropper sample (red, green, blue) tells of a surface's colour before looking at the clip."""
    chroma, luma = chromaticity(np.asarray(sample_srgb, dtype=np.float64)[::-1])
    saturation = max(float(np.linalg.norm(chroma)), 1e-6)
    radial = chroma / saturation
    tangential = np.array([-radial[1], radial[0]])
    covariance = (_SATURATION_DEVIATION * saturation) ** 2 * np.outer(radial, radial)
    covariance += (_HUE_DEVIATION * saturation) ** 2 * np.outer(tangential, tangential)
    return ColourDistribution(float(np.log(luma)), _LOG_LUMA_DEVIATION, chroma, np.zeros(2), covariance)


def fit_distribution(pixels: NDArray[np.uint8], start: ColourDistribution) -> ColourDistribution:
    """Fit a distribution to a surface's pixels, robustly, and never narrower than pixel noise.

    Args:
        pixels: (N, 3) blue, green, red.
        start: the sample's own distribution; the fit's centre stays within its reach.
    """
    chroma, luma = chromaticity(pixels)
    log_luma = np.log(luma)
    low, middle, high = np.quantile(log_luma, [0.1, 0.5, 0.9])
    deviation = max(float(high - low) / 2.563, _SMALLEST_LOG_LUMA_DEVIATION)
    light = log_luma - middle
    centre = np.median(chroma, axis=0)
    keep = np.sum((chroma - centre) ** 2, axis=1) <= np.quantile(np.sum((chroma - centre) ** 2, axis=1), 0.9)
    spread = float(light[keep] @ light[keep]) + len(pixels) * 0.01  # ridge: even light has no slope to tell
    slope = np.clip(light[keep] @ (chroma[keep] - centre) / spread, -_STEEPEST_SLOPE, _STEEPEST_SLOPE)
    residual = (chroma - centre - np.outer(light, slope))[keep]
    # The trimmed tenth holds a quarter to a half of the variance; noise is added where distances are taken.
    covariance = 1.5 * residual.T @ residual / max(len(residual), 1)
    covariance += (NOISE_LEVELS / np.exp(middle)) ** 2 * np.eye(2)
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
    return float(offset @ np.linalg.solve(start.covariance, offset)) <= _WEAK


def _grow(
    image: Image, distributions: Sequence[ColourDistribution], allowed: NDArray[np.bool_] | None
) -> NDArray[np.int16]:
    """Label the connected regions that hold enough of a marker's core colour; -1 elsewhere."""
    cells, inverse = np.unique(cell_index(image), return_inverse=True)
    shift = CELLS_PER_CHANNEL.bit_length() - 1
    middle = 256 / CELLS_PER_CHANNEL
    colours = np.stack([cells >> 2 * shift, cells >> shift & CELLS_PER_CHANNEL - 1, cells & CELLS_PER_CHANNEL - 1], -1)
    pairs = [distribution.distance((colours + 0.5) * middle) for distribution in distributions]
    nearest = np.argmax([density for _, density in pairs], axis=0)
    distance = np.array([squared for squared, _ in pairs])[nearest, np.arange(len(cells))]
    shape = image.shape[:2]
    nearest_image, distance_image = nearest[inverse].reshape(shape), distance[inverse].reshape(shape)
    label = np.full(shape, -1, dtype=np.int16)
    for marker in range(len(distributions)):
        weak = (nearest_image == marker) & (distance_image < _WEAK)
        if allowed is not None:
            weak &= allowed[marker]
        label[_with_core(weak, weak & (distance_image < _STRONG))] = marker
    return label


def _with_core(weak: NDArray[np.bool_], strong: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Keep connected regions of which enough is of the core colour and which are not most of the image."""
    count, components, stats, _ = cv2.connectedComponentsWithStats(weak.astype(np.uint8), connectivity=8)
    core = np.bincount(components[strong], minlength=count)
    area = stats[:, cv2.CC_STAT_AREA]
    good = (core >= np.maximum(4, 0.25 * area)) & (area <= _LARGEST_SHARE * weak.size)
    good[0] = False
    return np.asarray(good[components])


def _interior(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the mask without its mixed border where that leaves enough of it."""
    inner = cv2.erode(mask.astype(np.uint8), _KERNEL).astype(np.bool_)
    return inner if np.count_nonzero(inner) >= 0.25 * np.count_nonzero(mask) else mask


def _background_counts(images: Sequence[Image], regions: Sequence[NDArray[np.int16]]) -> FloatArray:
    counts = np.zeros(CELL_COUNT)
    for image, label in zip(images, regions, strict=True):
        near = cv2.dilate((label >= 0).astype(np.uint8), _KERNEL, iterations=_BACKGROUND_MARGIN)
        counts += np.bincount(cell_index(image[near == 0]), minlength=CELL_COUNT)
    cube = counts.reshape((CELLS_PER_CHANNEL,) * 3)
    return np.asarray(gaussian_filter(cube, sigma=1.0, mode="nearest", truncate=2.0)).ravel()
