"""Indexed frames: sampled frames of a clip as indices into a table of their colors, for color learning."""

from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Image, IntArray
from ..video.working_image import smooth
from .color_model import BACKGROUND, CELL_COUNT, SIDE, ColorDistribution, cell_chromaticity, cell_index, weigh
from .ignored_regions import is_ignored
from .moments import CROSS

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
