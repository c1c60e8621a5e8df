"""Streaming color learning: which frames colors are learned from, and when, while a clip is being read.

The learning itself is `color_learning`.
"""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from ...arrays import Array, Image, IndexArray
from ...errors import InputError
from ...files.digest import digest
from ..ignored_regions import IgnoredPixels
from ..region_tracks import Detections, ExpectedRegions, LearningRound, MarkerStyle, color_groups
from ..segmentation.working_image import halvings, learning_image, measuring_image
from .color_learning import LearnedColors, learn_colors
from .color_model import ColorModel, nearest_colors, share_of_color

SAMPLES = 12  # frames of the first learning; up to three times as many are kept later
WIDEST_SPACING = 96  # frames between samples at most: light changes in seconds
FAR = 10000  # limit of drawn coordinates in px


class StreamingColorLearner:
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
            # Centers of equal intervals: neither the first frame nor the last, which fades and cuts spoil.
            middles = (np.arange(count) + 0.5) * len(images) / count
            indices = sorted({int(middle) for middle in middles})
            self._samples = [(index, learning_image(images[index])) for index in indices]
            self._learn()
            if not self._missing.size:
                break
        self._spacing = min(max(len(images) // len(self._samples), 1), WIDEST_SPACING)

    def watch(self, index: int, image: Image) -> None:
        """Sample a later image, (rows, columns, 3) of the clip's size, at the present spacing of samples.

        Colors are learned anew once there are three times as many samples as at first; a third is then kept.
        """
        if index - self._samples[-1][0] < self._spacing:
            return
        self._samples.append((index, learning_image(measuring_image(image, self._times))))
        if len(self._samples) >= 3 * SAMPLES:
            self._samples = self._samples[2::3]
            self._spacing = min(3 * self._spacing, WIDEST_SPACING)
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
        counts = self._learned.background_counts
        return {
            marker: _complaint(self._styles[marker], counts)
            for color in self._missing.tolist()
            for marker in self.groups[color]
        }

    @property
    def _missing(self) -> IndexArray:
        return np.flatnonzero(self._most_found < 12)  # pixels

    def _learn(self) -> None:
        samples = [_mean_color([self._styles[marker] for marker in group]) for group in self.groups]
        allowed = None
        if self._expected is not None:
            allowed = [
                self._allowed(index, image.shape[:2], self._expected) for index, image in self._samples
            ]
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

    def _allowed(self, frame: int, shape: tuple[int, ...], expected: ExpectedRegions) -> Image | None:
        """Masks of each color's expected regions on the learning grid, (C, rows, columns)."""
        if frame >= len(expected.center):
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
                x, y, radius = np.clip(circle, -FAR, FAR).round().astype(int).tolist()
                cv2.circle(mask, (x, y), radius, (1.0,), -1)
        return masks


def _mean_color(styles: Sequence[MarkerStyle]) -> tuple[int, int, int]:
    red, green, blue = np.round(np.mean([style.color_srgb for style in styles], axis=0)).astype(int).tolist()
    return red, green, blue


def _complaint(style: MarkerStyle, counts: Array) -> str:
    """Why a color was not found, by the background's histogram (CELL_COUNT,), as a sentence."""
    color = list(style.color_srgb)
    share = share_of_color(counts, style.color_srgb)
    if share > 0.02:  # a wall's or a floor's
        return (
            f"{style.name} has the color {color}, which {100.0 * share:.0f} % of the picture around the "
            "markers have too, so it cannot be told apart; wear a color that the surroundings do not "
            "have"
        )
    nearest = ", ".join(str(list(near)) for near in nearest_colors(counts, style.color_srgb))
    return (
        f"{style.name} has the color {color}, which matches nothing in the clip; pick it on the marker "
        f"in a frame (the nearest colors found are {nearest})"
    )
