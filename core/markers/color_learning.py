"""Color learning: the markers' color distributions, from one sample each and frames of the clip."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Image, IndexArray, IntArray
from ..errors import InputError
from ..files.digest import digest
from ..video.clip import spread_frames
from ..video.working_image import halvings, learning_image, measuring_image, smooth
from .color_model import (
    BACKGROUND,
    CELL_COUNT,
    SIDE,
    ColorDistribution,
    ColorModel,
    cell_chromaticity,
    cell_index,
    chromaticity,
    color_model,
    nearest_colors,
    share_of_color,
    weigh,
)
from .ignored_regions import IgnoredPixels, is_ignored
from .moments import CROSS
from .region_tracks import Detections, ExpectedRegions, LearningRound, MarkerStyle

_Number = TypeVar("_Number", bound=np.generic)

LEARNING_NOISE_LEVELS = 2.5  # less than in classification: pixels explained by noise alone teach nothing


class CroppedMask(NamedTuple):
    """A mask of an image, cropped to its bounding box."""

    left: int  # first column of the box
    top: int  # its first row
    mask: Image  # (rows, columns) uint8, 0 or 1
    area: int  # pixels that are 1

    def within(self, whole: Image) -> "CroppedMask":
        """The intersection with a mask of the whole image."""
        mask = self.mask & self.crop(whole)
        return CroppedMask(self.left, self.top, mask, cv2.countNonZero(mask))

    def crop(self, image: NDArray[_Number]) -> NDArray[_Number]:
        """An image cropped to the mask's box."""
        rows, columns = self.mask.shape
        return image[self.top : self.top + rows, self.left : self.left + columns]


class IndexedFrames:
    """The sampled frames as indices into the table of the colors that occur in them."""

    def __init__(self, images: Sequence[Image], ignored: Sequence[Image | None] = ()) -> None:
        """Count the colors of images (rows, columns, 3) uint8, each with the mask of its ignored pixels."""
        cells = [cell_index(smooth(image)) for image in images]
        present = np.zeros(CELL_COUNT, dtype=np.bool_)
        for cell in cells:
            present[cell] = True
        self._table = np.flatnonzero(present).astype(np.int32)
        self._chroma, self._luma = cell_chromaticity(self._table)
        rank = np.zeros(CELL_COUNT, dtype=np.intp)
        rank[self._table] = np.arange(len(self._table))
        self._images = [rank.take(cell) for cell in cells]
        masks = ignored or [None] * len(cells)
        self._ignored = [None if mask is None else is_ignored(mask) for mask in masks]

    def near(self, distributions: Sequence[ColorDistribution]) -> Image:
        """Label each color of the table by the distribution in whose core it lies; 255 for none."""
        pairs = [one.distance(self._chroma, self._luma, LEARNING_NOISE_LEVELS) for one in distributions]
        nearest = np.argmax([density for _, density in pairs], axis=0)
        distance = np.array([squared for squared, _ in pairs])[nearest, np.arange(len(nearest))]
        # 95 % of χ² with 3 degrees of freedom.
        return np.where(distance < 7.8, nearest, BACKGROUND).astype(np.uint8)

    def weighed(
        self, distributions: Sequence[ColorDistribution], pixels: IntArray, background: Array
    ) -> Image:
        """Label each color of the table by its likeliest marker; 255 where the background is likelier."""
        label, probability = weigh(distributions, pixels, background[self._table], self._chroma, self._luma)
        return np.where(probability >= 0.5, label, BACKGROUND).astype(np.uint8)

    def regions(self, labels: Image, core: Image, markers: int) -> list[list[CroppedMask]]:
        """For each frame and marker, its connected regions with enough of its core color; no wall."""
        result: list[list[CroppedMask]] = []
        for image, ignored in zip(self._images, self._ignored, strict=True):
            label = labels.take(image)
            if ignored is not None:
                label[ignored] = BACKGROUND
            result.append([])
            for marker in range(markers):
                mask = np.equal(label, marker).view(np.uint8)
                left, top, columns, rows = cv2.boundingRect(mask)
                inside = slice(top, top + rows), slice(left, left + columns)
                part = np.ascontiguousarray(mask[inside])
                if columns:
                    count, number, stats, _ = cv2.connectedComponentsWithStats(
                        part, connectivity=8, ltype=cv2.CV_16U
                    )
                    pixel, component = np.flatnonzero(part), np.asarray(number).astype(np.intp)
                    pure = pixel[core.take(image[inside].take(pixel)) == marker]
                    strong = np.bincount(component.take(pure), minlength=count)
                    area = stats[:, cv2.CC_STAT_AREA]
                    good = (strong >= np.maximum(4, 0.25 * area)) & (area <= 0.25 * label.size)
                    good[0] = False
                    part = good.astype(np.uint8).take(component)
                result[-1].append(CroppedMask(left, top, part, cv2.countNonZero(part) if columns else 0))
        return result

    def colors(self, masks: Sequence[CroppedMask]) -> tuple[Array, Array]:
        """Chromaticity (N, 2) and offset luma (N,) of the insides of masks, one a frame."""
        inside = [np.zeros(0, dtype=np.intp)]
        for image, mask in zip(self._images, masks, strict=True):
            if mask.area:  # without the blended border, if enough remains
                inner = cv2.erode(mask.mask, CROSS, borderType=cv2.BORDER_CONSTANT, borderValue=(0.0,))
                kept = inner if cv2.countNonZero(inner) >= 0.25 * mask.area else mask.mask
                inside.append(mask.crop(image)[np.asarray(kept, dtype=np.bool_)])
        index = np.concatenate(inside)
        return self._chroma[index].astype(np.float64), self._luma[index].astype(np.float64)

    def background_counts(self, masks: Sequence[Sequence[CroppedMask]]) -> Array:
        """Smoothed histogram (CELL_COUNT,) of the colors at a distance from all masks and ignored pixels."""
        total = np.zeros(len(self._table))
        for image, ignored, placed in zip(self._images, self._ignored, masks, strict=True):
            covered = np.zeros(image.shape, dtype=np.uint8)
            if ignored is not None:
                covered[ignored] = 1
            for mask in placed:
                mask.crop(covered)[:] |= mask.mask
            near = cv2.dilate(covered, CROSS, iterations=3)
            total += np.bincount(image.ravel(), weights=1.0 - near.ravel(), minlength=len(self._table))
        counts, side = np.zeros(CELL_COUNT), SIDE
        counts[self._table] = total
        # A Gaussian of one cell's deviation, cut off after two.
        spread = np.exp(-0.5 * np.arange(-2.0, 3.0) ** 2)
        spread /= np.sum(spread)
        # Two channels are rows and columns of an image with as many channels as cells in the third.
        cube, edge = counts.reshape(side, side, side), cv2.BORDER_REPLICATE
        cube = np.asarray(cv2.sepFilter2D(cube, -1, spread, spread, borderType=edge))
        lines = cv2.sepFilter2D(cube.reshape(-1, side), -1, spread, np.ones(1), borderType=edge)
        return np.asarray(lines.ravel(), dtype=np.float64)


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
