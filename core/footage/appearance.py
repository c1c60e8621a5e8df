"""How the parts of a performer and the place behind him look: color densities, learned from a clip itself.

A static camera sees the same background whenever the performer is not before it: a color for each pixel,
which a shadow darkens (Stauffer & Grimson 1999, *Adaptive background mixture models*, with one component
and shadows as Horprasert, Harwood & Davis 1999 describe them). Each part of the body, and the background
where it was never free, has the histogram of its colors instead.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..arrays import Array, BoolArray, Image, IndexArray

NOTHING = -1
"""Label of pixels where no part of the body is."""
BITS = 5
LEVELS = 1 << BITS
CELLS = LEVELS**3
CELL_VOLUME = (256 / LEVELS) ** 3
UNSEEN = 0.02
"""Share of any surface's colors that a few frames do not show."""
BLUR = gaussian_filter1d(np.eye(LEVELS), 1.0, axis=0, truncate=3.0)
"""Takes a histogram's levels along an axis to smoothed ones."""
STRANGE = float(np.log(UNSEEN / (CELLS * CELL_VOLUME)))
"""Log density of a color that was never seen on any surface."""
MARGIN_PX = 5
"""A predicted body may lie this far off: what is nearer to it is not taken for background."""
FEWEST_FREE = 3
HIGHEST = 255
"""In place of a level that was not free: put last."""
SPARSE = 2
"""Every so many-th row and column tell enough of the colors of all the background."""
SMALLEST_DEVIATION, _LARGEST_DEVIATION = 3.0, 12.0
"""Bounds of a background pixel's standard deviation in levels."""
STEADY = 6.0
"""Most pixels of a background that stands still vary less than this, in levels."""
STEADY_SHARE = 0.9
DARKEST, _BRIGHTEST, _LIGHT_DEVIATION = 0.55, 1.1, 0.15
"""Range and standard deviation of the light that falls on a background pixel, relative to its usual light."""
CHANGED = 0.1
"""Share of pixels that show something else than the background's usual color."""


@dataclass(frozen=True, eq=False)
class Appearance:
    """Log densities of colors, per level³."""

    parts: Array
    """(O + 1, cells) of each part of the body and, last, of all the background."""
    color: Array
    """(rows, columns, 3) of the background."""
    deviation: Array
    """(rows, columns) standard deviation of the background's color, in levels."""
    known: BoolArray
    """(rows, columns) whether the background was seen there often enough."""
    steady: bool
    """Whether the background stands still, so that what differs from it is something else."""

    def part(self, index: IndexArray, pixels: Image) -> Array:
        """Return the log density of pixels (..., 3) as parts of index (...), broadcast against them."""
        return np.asarray(self.parts[index, _cells(pixels)])

    def background(self, row: IndexArray, column: IndexArray, pixels: Image) -> Array:
        """Return the log density of pixels (..., 3) as the background at rows and columns (...).

        In float64: exponentials of float32 differ between versions of numpy in their last digit, and edges
        that such differences move by a millionth of a pixel are, now and then, read from the next pixel.
        """
        anywhere = self.parts[-1, _cells(pixels)].astype(np.float64)
        deviation = self.deviation[row, column].astype(np.float64)
        # Channel by channel: sums over an axis of three are slow.
        usual = [self.color[..., channel][row, column].astype(np.float64) for channel in range(3)]
        seen = [pixels[..., channel].astype(np.float64) for channel in range(3)]
        power = usual[0] * usual[0] + usual[1] * usual[1] + usual[2] * usual[2]
        light = usual[0] * seen[0] + usual[1] * seen[1] + usual[2] * seen[2]
        light = np.clip(light / np.maximum(power, 1.0), DARKEST, _BRIGHTEST)
        squared = sum((s - light * u) ** 2 for s, u in zip(seen, usual, strict=True)) / deviation**2
        squared += ((light - 1.0) / _LIGHT_DEVIATION) ** 2
        here = np.exp(-0.5 * squared) / (deviation**3 * (2.0 * np.pi) ** 1.5)
        mixed = (1.0 - CHANGED) * here + CHANGED * np.exp(anywhere)
        # Blends at an edge are as strange to either side, and must speak for none.
        mixed = np.log((1.0 - UNSEEN) * mixed + np.exp(STRANGE))
        return np.where(self.known[row, column], mixed, anywhere)


def learn_appearance(images: list[Image], labels: list[NDArray[np.int8]], parts: int) -> Appearance:
    """Learn how parts and background look from frames in which the body's place is roughly known.

    Args:
        images: frames (rows, columns, 3) of a camera that stands still.
        labels: for each, (rows, columns), which part is seen, `NOTHING` where none is.
        parts: number of parts, O.
    """
    wide = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * MARGIN_PX + 1, 2 * MARGIN_PX + 1))
    body = np.stack([cv2.dilate((label != NOTHING).astype(np.uint8), wide) for label in labels]) > 0
    seen = [_seen(image, label, near, parts) for image, label, near in zip(images, labels, body, strict=True)]
    counts = np.bincount(np.concatenate(seen), minlength=(parts + 1) * CELLS).reshape(parts + 1, CELLS)
    color, spread = _middle_and_spread(np.stack(images), ~body)
    known = np.count_nonzero(~body, axis=0) >= FEWEST_FREE
    steady = bool(known.any() and np.mean(spread[known] < STEADY) >= STEADY_SHARE)
    deviation = np.clip(spread, SMALLEST_DEVIATION, _LARGEST_DEVIATION)
    return Appearance(_log_densities(counts), color, deviation, known, steady)


def _seen(image: Image, label: NDArray[np.int8], near: BoolArray, parts: int) -> IndexArray:
    """Return the color cells seen inside parts and well outside them, each part's after the last's."""
    rows, columns = np.nonzero(_interior(label) & (label != NOTHING))
    inside = label[rows, columns].astype(np.intp) * CELLS + _cells(image[rows, columns])
    sparse = slice(None, None, SPARSE), slice(None, None, SPARSE)
    return np.concatenate([inside, parts * CELLS + _cells(image[sparse][~near[sparse]])])


def _cells(pixels: Image) -> IndexArray:
    """Return the color cell of pixels (..., 3), coarser than those that tell markers apart."""
    reduced = (pixels >> (8 - BITS)).astype(np.intp)
    return np.asarray((reduced[..., 0] << 2 * BITS) | (reduced[..., 1] << BITS) | reduced[..., 2])


def _interior(label: NDArray[np.int8]) -> BoolArray:
    """Return which pixels have only neighbors of their own label."""
    kernel = np.ones((3, 3), dtype=np.uint8)
    shifted = (label + 1).astype(np.uint8)
    return np.asarray(cv2.erode(shifted, kernel) == cv2.dilate(shifted, kernel))


def _log_densities(counts: IndexArray) -> Array:
    """Return the logarithm of smoothed histograms (rows, cells) as densities per level³."""
    smoothed = counts.astype(np.float64).reshape(-1, LEVELS, LEVELS, LEVELS)
    for _ in range(3):  # each time along what is the last axis, and turns them
        smoothed = np.moveaxis(smoothed @ BLUR, -1, 1)
    smoothed = smoothed.reshape(counts.shape)
    share = smoothed / np.maximum(smoothed.sum(axis=1, keepdims=True), 1.0)
    density = np.log((1.0 - UNSEEN) * share / CELL_VOLUME + np.exp(STRANGE))
    return np.asarray(density.astype(np.float32))


def _middle_and_spread(stack: Image, free: BoolArray) -> tuple[Array, Array]:
    """Return the median color (rows, columns, 3) and the largest channel's deviation of free pixels."""
    color = _median(stack, free)
    distance = _median(np.stack([cv2.absdiff(image, color) for image in stack]), free)
    largest = np.maximum(np.maximum(distance[..., 0], distance[..., 1]), distance[..., 2])
    return color.astype(np.float32), 1.48 * largest.astype(np.float32)


def _median(stack: Image, free: BoolArray) -> Image:
    """Return the lower median over the free ones of the leading axis; the highest where nothing is free."""
    last = stack.copy()
    last[~free] = HIGHEST
    ordered = list(last)
    # Whole pictures at a time, that is many times as fast as sorting every pixel.
    for i, j in _exchanges(len(ordered)):
        ordered[i], ordered[j] = np.minimum(ordered[i], ordered[j]), np.maximum(ordered[i], ordered[j])
    middle = np.maximum(np.count_nonzero(free, axis=0) - 1, 0) // 2
    rows, columns = np.indices(middle.shape, sparse=True)
    return np.asarray(np.stack(ordered)[middle, rows, columns])


def _exchanges(count: int) -> Iterator[tuple[int, int]]:
    """Yield the pairs that, each put in order, sort (Batcher 1968, *Sorting networks*: odd-even merging)."""
    merged = 1
    while merged < count:
        apart = merged
        while apart:
            for start in range(apart % merged, count - apart, 2 * apart):
                for i in range(start, min(start + apart, count - apart)):
                    if i // (2 * merged) == (i + apart) // (2 * merged):
                        yield i, i + apart
            apart //= 2
        merged *= 2
