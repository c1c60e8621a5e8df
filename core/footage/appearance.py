"""How the parts of a performer and the place behind him look: colour densities, learned from a clip itself.

A static camera sees the same background whenever the performer is not before it: a colour for each pixel,
which a shadow darkens (Stauffer & Grimson 1999, *Adaptive background mixture models*, with one component
and shadows as Horprasert, Harwood & Davis 1999 describe them). Each part of the body, and the background
where it was never free, has the histogram of its colours instead.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]
Image = NDArray[np.uint8]

NOTHING: Final = -1
"""Label of pixels where no part of the body is."""
_BITS: Final = 5
_LEVELS: Final = 1 << _BITS
_CELLS: Final = _LEVELS**3
_CELL_VOLUME: Final = (256 / _LEVELS) ** 3
_UNSEEN: Final = 0.02
"""Share of any surface's colours that a few frames do not show."""
_STRANGE: Final = float(np.log(_UNSEEN / (_CELLS * _CELL_VOLUME)))
"""Log density of a colour that was never seen on any surface."""
_MARGIN_PX: Final = 5
"""A predicted body may lie this far off: what is nearer to it is not taken for background."""
_FEWEST_FREE: Final = 3
_NEVER: Final = 10_000
"""In place of a level that was never free."""
_SMALLEST_DEVIATION, _LARGEST_DEVIATION = 3.0, 12.0
"""Bounds of a background pixel's standard deviation in levels."""
_STEADY: Final = 6.0
"""Most pixels of a background that stands still vary less than this, in levels."""
_STEADY_SHARE: Final = 0.9
_DARKEST, _BRIGHTEST, _LIGHT_DEVIATION = 0.55, 1.1, 0.15
"""Range and standard deviation of the light that falls on a background pixel, relative to its usual light."""
_CHANGED: Final = 0.1
"""Share of pixels that show something else than the background's usual colour."""


@dataclass(frozen=True, eq=False)
class Appearance:
    """Log densities of colours, per level³.

    Attributes:
        parts: (O + 1, cells) of each part of the body and, last, of all the background.
        colour: (rows, columns, 3) of the background.
        deviation: (rows, columns) standard deviation of the background's colour, in levels.
        known: (rows, columns) whether the background was seen there often enough.
        steady: whether the background stands still, so that what differs from it is something else.
    """

    parts: FloatArray
    colour: FloatArray
    deviation: FloatArray
    known: BoolArray
    steady: bool

    def part(self, index: IntArray, pixels: Image) -> FloatArray:
        """Return the log density of pixels (..., 3) as parts of index (...), broadcast against them."""
        return np.asarray(self.parts[index, _cells(pixels)])

    def background(self, row: IntArray, column: IntArray, pixels: Image) -> FloatArray:
        """Return the log density of pixels (..., 3) as the background at rows and columns (...)."""
        anywhere = np.asarray(self.parts[-1, _cells(pixels)])
        usual, deviation = self.colour[row, column], self.deviation[row, column]
        seen = pixels.astype(np.float64)
        power = np.maximum(np.sum(usual**2, axis=-1), 1.0)
        light = np.clip(np.sum(usual * seen, axis=-1) / power, _DARKEST, _BRIGHTEST)
        squared = np.sum((seen - light[..., None] * usual) ** 2, axis=-1) / deviation**2
        squared += ((light - 1.0) / _LIGHT_DEVIATION) ** 2
        here = -0.5 * squared - 3.0 * np.log(deviation) - 1.5 * np.log(2.0 * np.pi)
        mixed = np.logaddexp(np.log(1.0 - _CHANGED) + here, np.log(_CHANGED) + anywhere)
        # Blends at an edge are as strange to either side, and must speak for none.
        mixed = np.logaddexp(np.log(1.0 - _UNSEEN) + mixed, _STRANGE)
        return np.where(self.known[row, column], mixed, anywhere)


def learn_appearance(images: list[Image], labels: list[NDArray[np.int8]], parts: int) -> Appearance:
    """Learn how parts and background look from frames in which the body's place is roughly known.

    Args:
        images: frames (rows, columns, 3) of a camera that stands still.
        labels: for each, (rows, columns), which part is seen, `NOTHING` where none is.
        parts: number of parts, O.
    """
    wide = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * _MARGIN_PX + 1, 2 * _MARGIN_PX + 1))
    body = np.stack([cv2.dilate((label != NOTHING).astype(np.uint8), wide) > 0 for label in labels])
    counts = np.zeros((parts + 1, _CELLS))
    for image, label, near in zip(images, labels, body, strict=True):
        cells = _cells(image)
        index = np.where(_interior(label) & (label != NOTHING), label, parts)
        counted = (index != parts) | ~near
        flat = index[counted].astype(np.intp) * _CELLS + cells[counted]
        counts += np.bincount(flat, minlength=counts.size).reshape(counts.shape)
    colour, spread = _middle_and_spread(np.stack(images), ~body)
    known = np.count_nonzero(~body, axis=0) >= _FEWEST_FREE
    steady = bool(known.any() and np.mean(spread[known] < _STEADY) >= _STEADY_SHARE)
    deviation = np.clip(spread, _SMALLEST_DEVIATION, _LARGEST_DEVIATION)
    return Appearance(np.stack([_log_density(row) for row in counts]), colour, deviation, known, steady)


def _cells(pixels: Image) -> IntArray:
    """Return the colour cell of pixels (..., 3), coarser than those that tell markers apart."""
    reduced = (pixels >> (8 - _BITS)).astype(np.intp)
    return np.asarray((reduced[..., 0] << 2 * _BITS) | (reduced[..., 1] << _BITS) | reduced[..., 2])


def _interior(label: NDArray[np.int8]) -> BoolArray:
    """Return which pixels have only neighbours of their own label."""
    kernel = np.ones((3, 3), dtype=np.uint8)
    shifted = (label + 1).astype(np.uint8)
    return np.asarray(cv2.erode(shifted, kernel) == cv2.dilate(shifted, kernel))


def _log_density(counts: FloatArray) -> FloatArray:
    """Return the logarithm of a smoothed histogram as density per level³."""
    smoothed = gaussian_filter(counts.reshape((_LEVELS,) * 3), 1.0, truncate=3.0).ravel()
    share = smoothed / max(float(smoothed.sum()), 1.0)
    return np.asarray(
        np.logaddexp(np.log(np.maximum((1.0 - _UNSEEN) * share / _CELL_VOLUME, 1e-300)), _STRANGE)
    )


def _middle_and_spread(stack: Image, free: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Return the median colour (rows, columns, 3) and the largest channel's deviation of free pixels."""
    levels = stack.astype(np.int16)
    colour = _median(levels, free)
    spread = 1.48 * _median(np.abs(levels - colour), free).max(axis=-1)
    return colour.astype(np.float64), np.asarray(spread, dtype=np.float64)


def _median(stack: NDArray[np.int16], free: BoolArray) -> NDArray[np.int16]:
    """Return the lower median over the free ones of the leading axis; zero where nothing is free."""
    # The leading axis last and whole numbers: both make sorting several times as fast.
    values = np.where(free[..., None], stack, np.int16(_NEVER)).transpose(1, 2, 3, 0)
    ordered = np.sort(np.ascontiguousarray(values), axis=-1, kind="stable")
    middle = np.maximum(np.count_nonzero(free, axis=0) - 1, 0) // 2
    found = np.take_along_axis(ordered, middle[..., None, None], axis=-1)[..., 0]
    return np.where(found == _NEVER, np.int16(0), found)
