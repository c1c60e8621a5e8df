"""Appearance of body parts, band by band, and of the background: color likelihoods learned from the clip.

The background of a static camera has one Gaussian a pixel, which shadows may darken (Stauffer & Grimson 1999,
*Adaptive background mixture models*, with one component and shadows as Horprasert, Harwood & Davis 1999
describe them). Each part of the body has a color histogram, and so has the background where the performer
always occludes it.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import cv2
import numpy as np
import scipy
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, Image, IndexArray

NO_PART = -1  # label of pixels without a part of the body
LEVELS = 32  # of each channel, 8 values wide
CELLS = LEVELS**3
UNSEEN = 0.02  # share of any surface's colors that a few frames do not show
UNSEEN_LOG_DENSITY = float(np.log(UNSEEN / (CELLS * 8.0**3)))
"""Log density of a color that was never seen on any surface."""
STEADY = 6.0  # standard deviation below which a background pixel is static, in levels


@dataclass(frozen=True, eq=False)
class Appearance:
    """Log likelihoods of colors, as densities per level³."""

    parts: Array  # (O + 1, cells) histogram of each part of the body and, last, of the whole background
    color: Array  # (rows, columns, 3) median color of the background
    deviation: Array  # (rows, columns) standard deviation of the background's color, in levels
    known: BoolArray  # (rows, columns) whether the background was visible in enough frames
    steady: bool  # whether the background is static, so that pixels that differ from it are foreground

    def with_parts(self, images: list[Image], labels: list[NDArray[np.int8]], parts: int) -> "Appearance":
        """This appearance with the colors of O parts learned from frames in which the body is known best."""
        nothing = np.ones(labels[0].shape, dtype=np.bool_)
        own = _log_densities(_counts(images, labels, [nothing] * len(images), parts)[:-1])
        return replace(self, parts=np.concatenate([own, self.parts[-1:]]))

    def where_steady(self) -> "Appearance":
        """This appearance with only those pixels of the background known that stand still.

        Before a flickering screen or waving leaves these are left out, and the others keep what they tell.
        """
        known = self.known & (self.deviation < STEADY)
        # Where each pixel is judged by itself.
        return replace(self, known=known, steady=bool(np.mean(known) >= 0.5))

    def part(self, index: IndexArray, pixels: Image) -> Array:
        """Log likelihood of pixels (..., 3) under the parts `index` (...), broadcast against them."""
        return np.asarray(self.parts[index, histogram_cells(pixels, 5)])

    def background(self, row: IndexArray, column: IndexArray, pixels: Image) -> Array:
        """Log likelihood of pixels (..., 3) under the background at rows and columns (...).

        In float64: exponentials of float32 differ between versions of numpy in their last digit, which moves
        edges by a millionth of a pixel and, now and then, onto the next pixel.
        """
        anywhere = self.parts[-1, histogram_cells(pixels, 5)].astype(np.float64)
        deviation = self.deviation[row, column].astype(np.float64)
        # Channel by channel: sums over an axis of three are slow.
        usual = [self.color[..., channel][row, column].astype(np.float64) for channel in range(3)]
        seen = [pixels[..., channel].astype(np.float64) for channel in range(3)]
        power = usual[0] * usual[0] + usual[1] * usual[1] + usual[2] * usual[2]
        light = usual[0] * seen[0] + usual[1] * seen[1] + usual[2] * seen[2]
        light = np.clip(light / np.maximum(power, 1.0), 0.55, 1.1)  # relative to usual
        squared = sum((s - light * u) ** 2 for s, u in zip(seen, usual, strict=True)) / deviation**2
        squared += ((light - 1.0) / 0.15) ** 2
        here = np.exp(-0.5 * squared) / (deviation**3 * (2.0 * np.pi) ** 1.5)
        mixed = 0.9 * here + 0.1 * np.exp(anywhere)  # a tenth of all pixels differs from the usual color
        # Blends at an edge are equally unlikely on either side, and must favor neither.
        mixed = np.log((1.0 - UNSEEN) * mixed + np.exp(UNSEEN_LOG_DENSITY))
        return np.where(self.known[row, column], mixed, anywhere)


def learn_appearance(images: list[Image], labels: list[NDArray[np.int8]], parts: int) -> Appearance:
    """Learn from frames (rows, columns, 3) of a static camera and a rough segmentation into O parts.

    `labels` are, for each frame, (rows, columns) the visible part of the body, `NO_PART` for none.
    """
    # A predicted body is off by 5 pixels: those nearer to it do not count as background.
    wide = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (11, 11))
    body = np.stack([cv2.dilate((label != NO_PART).astype(np.uint8), wide) for label in labels]) > 0
    densities, stack = _log_densities(_counts(images, labels, body, parts)), np.stack(images)
    color = _median(stack, ~body)
    distance = _median(np.stack([cv2.absdiff(image, color) for image in stack]), ~body)
    spread = 1.48 * distance.max(axis=-1).astype(np.float32)  # that of the most variable channel
    # Frames that must show a pixel's background for its Gaussian to be known.
    known = np.count_nonzero(~body, axis=0) >= 3
    steady = bool(known.any() and np.mean(spread[known] < STEADY) >= 0.9)
    deviation = np.clip(spread, 3.0, 12.0)  # of a background pixel, in levels
    return Appearance(densities, color.astype(np.float32), deviation, known, steady)


def _counts(
    images: list[Image], labels: list[NDArray[np.int8]], body: Iterable[BoolArray], parts: int
) -> IndexArray:
    """(O + 1, cells) how often each color was seen inside each part and, last, well outside the body."""
    seen, kernel = [], np.ones((3, 3), dtype=np.uint8)
    for image, label, near in zip(images, labels, body, strict=True):
        shifted = (label + 1).astype(np.uint8)
        interior = np.asarray(cv2.erode(shifted, kernel) == cv2.dilate(shifted, kernel))
        rows, columns = np.nonzero(interior & (label != NO_PART))
        seen.append(label[rows, columns].astype(np.intp) * CELLS + histogram_cells(image[rows, columns], 5))
        # Of the background every other pixel counts.
        seen.append(parts * CELLS + histogram_cells(image[::2, ::2][~near[::2, ::2]], 5))
    return np.bincount(np.concatenate(seen), minlength=(parts + 1) * CELLS).reshape(parts + 1, CELLS)


def histogram_cells(pixels: Image, bits: int) -> IndexArray:
    """Cell of pixels (..., 3) in a histogram of so many bits a channel."""
    reduced = (pixels >> (8 - bits)).astype(np.intp)
    return np.asarray((reduced[..., 0] << 2 * bits) | (reduced[..., 1] << bits) | reduced[..., 2])


def _log_densities(counts: IndexArray) -> Array:
    """Log densities per level³ of smoothed histograms (rows, cells)."""
    smoothed = counts.astype(np.float64).reshape(-1, LEVELS, LEVELS, LEVELS)
    blur = scipy.ndimage.gaussian_filter1d(np.eye(LEVELS), 1.0, axis=0, truncate=3.0)
    for _ in range(3):  # each time along the last axis, which then becomes the second
        smoothed = np.moveaxis(smoothed @ blur, -1, 1)
    smoothed = smoothed.reshape(counts.shape)
    share = smoothed / np.maximum(smoothed.sum(axis=1, keepdims=True), 1.0)
    density = np.log((1.0 - UNSEEN) * share / 8.0**3 + np.exp(UNSEEN_LOG_DENSITY))
    return np.asarray(density.astype(np.float32))


def _median(stack: Image, free: BoolArray) -> Image:
    """Lower median over the free entries of the leading axis; 255 where none is free."""
    ordered = np.sort(np.where(free[..., None], stack, np.uint8(255)), axis=0)
    middle = np.maximum(np.count_nonzero(free, axis=0) - 1, 0) // 2
    rows, columns = np.indices(middle.shape, sparse=True)
    return np.asarray(ordered[middle, rows, columns])


BANDS = 6  # bands of a part's length
BAND_LEVELS = 16  # coarser than whole parts' colors: a band has a sixth of their pixels
BAND_CELLS = BAND_LEVELS**3


@dataclass(frozen=True, eq=False)
class BandColors:
    """Log likelihoods of colors, as densities per cell."""

    bands: Array  # (O, BANDS, cells) of each part's bands
    parts: Array  # (O, cells) of whole parts
    anything: Array  # (cells,) of performer and background together


def learn_band_colors(
    images: list[Image], labels: list[NDArray[np.int8]], shares: list[Array], count: int
) -> BandColors:
    """Learn the colors along all O parts, from frames and labels as in `learn_appearance`.

    `shares` are (rows, columns) the place along the visible part, from 0 to 1 between its ends; NaN where it
    is seen end on.
    """
    size = count * BANDS * BAND_CELLS
    counts, background = np.zeros(size), np.zeros(BAND_CELLS)
    for image, label, share in zip(images, labels, shares, strict=True):
        cell = band_cells(image)
        inside = (label != NO_PART) & np.isfinite(share)
        band = np.clip(share[inside] * BANDS, 0, BANDS - 1).astype(np.intp)
        where = (label[inside].astype(np.intp) * BANDS + band) * BAND_CELLS + cell[inside]
        counts += np.bincount(where, minlength=size)
        background += np.bincount(cell[label == NO_PART], minlength=BAND_CELLS)
    own = counts.reshape(count, BANDS, BAND_CELLS)
    whole = _densities(own.sum(axis=1))
    bands = 0.75 * _densities(own) + 0.25 * whole[:, None]  # folds and shadows wander
    anything = 0.5 * (whole.mean(axis=0) + _densities(background))
    return BandColors(np.log(bands), np.log(whole), np.log(anything))


def band_cells(pixels: Image) -> IndexArray:
    """Histogram cell of pixels (..., 3)."""
    return histogram_cells(pixels, 4)


def _densities(counts: Array) -> Array:
    """Densities per cell of smoothed histograms (..., cells); an empty one is even."""
    grid = counts.reshape(*counts.shape[:-1], BAND_LEVELS, BAND_LEVELS, BAND_LEVELS)
    for axis in (-3, -2, -1):
        # Noise of a few levels.
        grid = scipy.ndimage.correlate1d(grid, np.array([0.16, 0.68, 0.16]), axis=axis, mode="nearest")
    smoothed = grid.reshape(counts.shape)
    total = smoothed.sum(axis=-1, keepdims=True)
    share = np.where(total > 0.0, smoothed / np.maximum(total, 1.0), 1.0 / BAND_CELLS)
    return np.asarray((1.0 - UNSEEN) * share + UNSEEN / BAND_CELLS)
