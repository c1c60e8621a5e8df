"""Color learning: the markers' color distributions, from one sample each and some frames of the clip."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array, BoolArray, Image, IntArray
from .color_model import ColorDistribution, ColorModel, chromaticity, color_model
from .indexed_frames import LEARNING_NOISE_LEVELS, CroppedMask, IndexedFrames

# Uncertainty of one sample: saturation by 15 %, hue by 6 degrees, light by a factor of 1.6 either way.

FARTHEST = 16.3  # squared distances: 99.9 % of a chi-squared with 3 degrees of freedom
STEEPEST_SLOPE = 0.25


@dataclass(frozen=True, eq=False)
class LearnedColors:
    """Colors learned from sampled frames."""

    model: ColorModel  # the color model, with the background as a class of its own
    found: IntArray
    """(M,) pixels found of each marker over the sampled frames; 0 where its color matches nothing."""
    background_counts: Array  # (CELL_COUNT,) background pixels per color cell


def learn_colors(
    images: Sequence[Image],
    samples_srgb: Sequence[tuple[int, int, int]],
    allowed: Sequence[Image | None] | None = None,
    ignored: Sequence[Image | None] = (),
) -> LearnedColors:
    """Learn each marker's color distribution and the background's histogram.

    Regions near each sample's color are segmented, the distribution is fitted to their pixels, and all other
    pixels are counted as background; the next round segments the regions again by the posterior of the two,
    and so on.

    Args:
        images: Sampled frames, (rows, columns, 3) uint8, on the learning grid.
        samples_srgb: One (red, green, blue) in 0..255 per marker.
        allowed: Per image, (M, rows, columns) 1 where each marker may be, or None for everywhere.
        ignored: Per image, the mask (rows, columns) of ignored pixels, or None; empty for none at all.
    """
    sampled = IndexedFrames(images, ignored)
    initial = [sample_distribution(sample) for sample in samples_srgb]
    distributions = list(initial)
    core = labels = sampled.near(initial)
    found, background = np.zeros(len(initial), dtype=np.int64), np.zeros(0)
    for turn in range(3):
        if turn:
            labels = sampled.weighed(distributions, np.maximum(found, 1), background)
        masks = sampled.regions(labels, core, len(initial))
        # Clutter of a marker's very color is kept out of the background too, or the marker would be lost.
        background = sampled.background_counts(masks)
        if allowed is not None:
            masks = [_allowed(own, limits) for own, limits in zip(masks, allowed, strict=True)]
        found = np.array([sum(own[marker].area for own in masks) for marker in range(len(initial))])
        for marker, start in enumerate(initial):
            chroma, luma = sampled.colors([own[marker] for own in masks])
            own = _near_sample(chroma, luma, start)
            if np.count_nonzero(own) >= 40:
                distributions[marker] = fit_distribution(chroma[own], luma[own], start)
    return LearnedColors(color_model(distributions, np.maximum(found, 1), background), found, background)


def sample_distribution(sample_srgb: tuple[int, int, int]) -> ColorDistribution:
    """Prior color distribution of a surface, from one sample (red, green, blue) alone."""
    chroma, luma = chromaticity(np.asarray(sample_srgb, dtype=np.float64)[::-1])
    saturation = float(np.linalg.norm(chroma))
    radial = chroma / saturation if saturation > 0.0 else np.array([1.0, 0.0])
    tangential = np.array([-radial[1], radial[0]])
    extent = max(saturation, 0.04)  # a gray has no hue
    covariance = (0.15 * extent) ** 2 * np.outer(radial, radial)  # saturation is off by 15 %
    covariance += (0.10 * extent) ** 2 * np.outer(tangential, tangential)  # hue by 6 degrees
    # Light by a factor of 1.6.
    return ColorDistribution(float(np.log(luma)), 0.45, chroma, np.zeros(2), covariance)


def fit_distribution(chroma: Array, luma: Array, start: ColorDistribution) -> ColorDistribution:
    """Fit a distribution to a surface's N pixels, robustly, and never narrower than pixel noise.

    Its center stays within the reach of the sample's own distribution.
    """
    log_luma = np.log(luma)
    low, middle, high = np.quantile(log_luma, [0.1, 0.5, 0.9])
    deviation = max(float(high - low) / 2.563, 0.3)
    light = log_luma - middle
    center = np.median(chroma, axis=0)
    keep = np.sum((chroma - center) ** 2, axis=1) <= np.quantile(np.sum((chroma - center) ** 2, axis=1), 0.9)
    spread = float(light[keep] @ light[keep]) + len(luma) * 0.01  # ridge: even light has no slope to tell
    slope = np.clip(light[keep] @ (chroma[keep] - center) / spread, -STEEPEST_SLOPE, STEEPEST_SLOPE)
    residual = (chroma - center - np.outer(light, slope))[keep]
    # Of a normal distribution's variance in the plane the trimmed tenth takes a third.
    # Pixel noise is not added here but where distances are taken.
    covariance = 1.5 * residual.T @ residual / max(len(residual), 1)
    # The frames between the sampled ones show other light, folds and blur; the background limits what this
    # admits.
    covariance += 0.2 * start.covariance
    fitted = replace(
        start,
        log_luma=float(middle),
        log_luma_deviation=deviation,
        mean=center,
        slope=slope,
        covariance=covariance,
    )
    return fitted if _within_reach(fitted, start) else start


def _within_reach(fitted: ColorDistribution, start: ColorDistribution) -> bool:
    offset = fitted.mean - start.mean
    return float(offset @ np.linalg.solve(start.covariance, offset)) <= FARTHEST


def _near_sample(chroma: Array, luma: Array, start: ColorDistribution) -> BoolArray:
    """Mark the pixels (N,) to learn from.

    Colors far from the sample are blends at a border, or skin and wood under warm light; learning from them
    would widen and move the distribution round by round.
    """
    distance, _ = start.distance(chroma, luma, LEARNING_NOISE_LEVELS)
    if not len(distance):
        return np.zeros(0, dtype=np.bool_)
    return distance <= np.clip(np.quantile(distance, 0.7), 2.4, FARTHEST)


def _allowed(masks: Sequence[CroppedMask], limits: Image | None) -> list[CroppedMask]:
    if limits is None:
        return list(masks)
    return [mask.within(limit) for mask, limit in zip(masks, limits, strict=True)]
