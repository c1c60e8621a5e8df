"""Color learning: the markers' color distributions, from one sample each and frames of the clip."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from ..arrays import Array, Image, IndexArray, IntArray
from ..errors import InputError
from ..files.digest import digest
from ..video.clip import spread_frames
from ..video.working_image import halvings, learning_image, measuring_image
from .color_model import (
    ColorDistribution,
    ColorModel,
    chromaticity,
    color_model,
    nearest_colors,
    share_of_color,
)
from .ignored_regions import IgnoredPixels
from .indexed_frames import LEARNING_NOISE_LEVELS, IndexedFrames
from .region_tracks import Detections, ExpectedRegions, LearningRound, MarkerStyle

SAMPLES = 12  # frames of the first learning; up to three times as many are kept later
FARTHEST = 16.3  # squared distance: 99.9 % of a chi-squared with 3 degrees of freedom


class ColorLearner:
    """Learns the colors of a clip's markers: from its first frames, and anew as it goes on."""

    groups: list[list[int]]  # the markers of each color; several where their samples are alike
    learning_rounds: list[LearningRound]  # rounds of learning so far
    samples: dict[int, Image]  # the images that were learned from, by frame

    def __init__(
        self,
        path: Path,
        size: tuple[int, int],
        styles: Sequence[MarkerStyle],
        expected: ExpectedRegions | None = None,
        ignored: IgnoredPixels | None = None,
    ) -> None:
        """Prepare for a clip of (width, height); expected regions keep clutter from being learned."""
        self.groups = color_groups(styles)
        self._path, self._styles, self._expected, self._ignored = path, styles, expected, ignored
        self._size, self._times = size, halvings(size)
        self._samples: list[tuple[int, Image]] = []
        self._spacing = 1
        self._learned: LearnedColors | None = None
        self._most_found = np.zeros(len(self.groups), dtype=np.int64)
        self.learning_rounds = []
        self.samples = {}

    @property
    def model(self) -> ColorModel:
        """The color model learned so far."""
        if self._learned is None:
            raise ValueError("nothing has been learned yet")
        return self._learned.model

    def learn(self, images: Sequence[Image]) -> None:
        """Learn from the clip's first images, (rows, columns, 3) on the measuring grid."""
        for count in (SAMPLES, 48):
            indices = spread_frames(len(images), count)
            self._samples = [(index, learning_image(images[index])) for index in indices]
            self._learn()
            if not self._missing.size:
                break
        self._spacing = min(max(len(images) // len(self._samples), 1), 96)  # light changes in seconds

    def watch(self, index: int, image: Image) -> None:
        """Sample a later image, (rows, columns, 3) of the clip's size, at the present spacing of samples.

        Colors are learned anew once there are three times as many samples as at first; a third is then kept.
        """
        if index - self._samples[-1][0] < self._spacing:
            return
        self._samples.append((index, learning_image(measuring_image(image, self._times))))
        if len(self._samples) >= 3 * SAMPLES:
            self._samples = self._samples[2::3]
            self._spacing = min(3 * self._spacing, 96)
            self._learn()

    def learn_again(self, earlier: Detections) -> bool:
        """Repeat the learning of earlier detections; whether it gives exactly the same colors."""
        for one in earlier.learning_rounds:
            self._samples = [(index, earlier.samples[index]) for index in one.frames]
            self._learn()
            if self.learning_rounds[-1] != one:
                return False
        return bool(earlier.learning_rounds)

    def check_found(self) -> None:
        """Refuse colors that match nothing in the clip, or that the surroundings have too."""
        for sentence in self.complaints().values():
            raise InputError(f"{self._path}: marker {sentence}")

    def complaints(self) -> dict[int, str]:
        """A sentence that begins with the name, for each marker found nowhere, by index."""
        if self._learned is None:
            return {}
        counts, sentences = self._learned.background_counts, {}
        for marker in (marker for color in self._missing.tolist() for marker in self.groups[color]):
            name, sample = self._styles[marker].name, self._styles[marker].color_srgb
            color, share = list(sample), share_of_color(counts, sample)
            if share > 0.02:  # a wall's or a floor's
                sentences[marker] = (
                    f"{name} has the color {color}, which {100.0 * share:.0f} % of the picture around the "
                    "markers have too, so it cannot be told apart; wear a color that the surroundings do not "
                    "have"
                )
            else:
                nearest = ", ".join(str(list(near)) for near in nearest_colors(counts, sample))
                sentences[marker] = (
                    f"{name} has the color {color}, which matches nothing in the clip; pick it on the marker "
                    f"in a frame (the nearest colors found are {nearest})"
                )
        return sentences

    @property
    def _missing(self) -> IndexArray:
        """Colors of which no learning has found a dozen pixels."""
        return np.flatnonzero(self._most_found < 12)

    def _learn(self) -> None:
        styles = [[self._styles[marker].color_srgb for marker in group] for group in self.groups]
        samples = [np.round(np.mean(colors, axis=0)).astype(int).tolist() for colors in styles]
        allowed = [self._allowed(index, image.shape[:2]) for index, image in self._samples]
        masks: list[Image | None] = []
        if self._ignored is not None and self._ignored.regions:
            whole = [self._ignored.mask(index) for index, _ in self._samples]
            masks = [None if mask is None else learning_image(mask) for mask in whole]
        self._learned = learn_colors([image for _, image in self._samples], samples, allowed, masks)
        self._most_found = np.maximum(self._most_found, self._learned.found)
        model = self._learned.model
        model_digest = digest(model.label, model.probability, self._learned.found)
        self.learning_rounds.append(LearningRound(tuple(index for index, _ in self._samples), model_digest))
        self.samples.update(self._samples)

    def _allowed(self, frame: int, shape: tuple[int, ...]) -> Image | None:
        """Masks of each color's expected regions (C, rows, columns) on the learning grid, if any."""
        expected = self._expected
        if expected is None or frame >= len(expected.center):
            return None
        masks = np.zeros((len(self.groups), *shape), dtype=np.uint8)
        step = self._size[0] / shape[1]
        for mask, group in zip(masks, self.groups, strict=True):
            for marker in group:
                # The radius bounds the centroid; the region itself reaches beyond it.
                circle = (*expected.center[frame, marker] / step, 1.5 * expected.radius[frame, marker] / step)
                if not np.isfinite(circle).all():
                    mask[:] = 1
                    continue
                x, y, radius = np.clip(circle, -10000, 10000).round().astype(int).tolist()
                cv2.circle(mask, (x, y), radius, (1.0,), -1)
        return masks


def color_groups(styles: Sequence[MarkerStyle]) -> list[list[int]]:
    """Group the indices of the markers by color; markers of indistinguishable colors are together."""
    groups: list[list[int]] = []
    samples = [sample_distribution(style.color_srgb) for style in styles]
    for index, one in enumerate(samples):
        alike = set()
        for known, other in enumerate(samples[:index]):
            offset, light = one.mean - other.mean, (one.log_luma - other.log_luma) ** 2
            squared = float(offset @ np.linalg.solve(one.covariance + other.covariance, offset))
            squared += light / (one.log_luma_deviation**2 + other.log_luma_deviation**2)
            if squared < 2.5:  # by Mahalanobis: light may make them equal
                alike.add(known)
        group = next((group for group in groups if alike.intersection(group)), None)
        if group is None:
            groups.append([index])
        else:
            group.append(index)
    return groups


@dataclass(frozen=True, eq=False)
class LearnedColors:
    """Colors learned from sampled frames."""

    model: ColorModel  # the color model, with the background as a class of its own
    found: IntArray
    """(M,) pixels found of each marker over the sampled frames; 0 where its color matches nothing."""
    background_counts: Array  # (CELL_COUNT,) background pixels per color cell


def learn_colors(
    images: Sequence[Image],
    samples_srgb: Sequence[Sequence[int]],
    allowed: Sequence[Image | None] = (),
    ignored: Sequence[Image | None] = (),
) -> LearnedColors:
    """Learn each marker's color distribution and the background's histogram.

    Regions near each sample's color are segmented, the distribution is fitted to their pixels, and all other
    pixels are counted as background; the next round segments the regions again by the posterior of the two,
    and so on.

    Args:
        images: Sampled frames, (rows, columns, 3) uint8, on the learning grid.
        samples_srgb: One (red, green, blue) in 0..255 per marker.
        allowed: Per image, (M, rows, columns) 1 where each marker may be, or None; empty for everywhere.
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
        for own, limits in zip(masks, allowed, strict=False):
            if limits is not None:
                own[:] = [mask.within(limit) for mask, limit in zip(own, limits, strict=True)]
        found = np.array([sum(own[marker].area for own in masks) for marker in range(len(initial))])
        for marker, start in enumerate(initial):
            chroma, luma = sampled.colors([own[marker] for own in masks])
            # Colors far from the sample are blends at a border, or skin and wood under warm light; learning
            # from them would widen and move the distribution round by round.
            distance, _ = start.distance(chroma, luma, LEARNING_NOISE_LEVELS)
            if len(distance):
                near = distance <= np.clip(np.quantile(distance, 0.7), 2.4, FARTHEST)
                if np.count_nonzero(near) >= 40:
                    distributions[marker] = fit_distribution(chroma[near], luma[near], start)
    return LearnedColors(color_model(distributions, np.maximum(found, 1), background), found, background)


def sample_distribution(sample_srgb: Sequence[int]) -> ColorDistribution:
    """Prior color distribution of a surface, from one sample (red, green, blue) alone."""
    chroma, luma = chromaticity(np.asarray(sample_srgb, dtype=np.float64)[::-1])
    saturation = float(np.linalg.norm(chroma))
    radial = chroma / saturation if saturation > 0.0 else np.array([1.0, 0.0])
    tangential = np.array([-radial[1], radial[0]])
    extent = max(saturation, 0.04)  # a gray has no hue
    # A sample's saturation is off by 15 %, its hue by 6 degrees, its light by a factor of 1.6 either way.
    covariance = (0.15 * extent) ** 2 * np.outer(radial, radial)
    covariance += (0.10 * extent) ** 2 * np.outer(tangential, tangential)
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
    slope = np.clip(light[keep] @ (chroma[keep] - center) / spread, -0.25, 0.25)
    residual = (chroma - center - np.outer(light, slope))[keep]
    # Of a normal distribution's variance in the plane the trimmed tenth takes a third.
    # Pixel noise is not added here but where distances are taken.
    covariance = 1.5 * residual.T @ residual / max(len(residual), 1)
    # The frames between the sampled ones show other light, folds and blur; the background limits what this
    # admits.
    covariance += 0.2 * start.covariance
    fitted = ColorDistribution(float(middle), deviation, center, slope, covariance)
    offset = fitted.mean - start.mean
    return fitted if offset @ np.linalg.solve(start.covariance, offset) <= FARTHEST else start
