"""Windows of some pictures side by side on one sheet, so that every step of the work is done once for all.

Each panel of the sheet serves one marker. Where a window reaches beyond the picture, the picture's border is
repeated, so that it is no edge of a region that it cuts.
"""

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from ...arrays import Image, IntArray
from .working_image import measuring_image

NO_COLOR = 254
"""Color of the columns between panels; no pixel bears it."""


class Window(NamedTuple):
    """A part of one of some images in which a color is looked for, in pixels of the image halved `times`."""

    image: int
    times: int
    color: int
    left: int
    top: int
    right: int
    bottom: int


class Atlas(NamedTuple):
    """Windows side by side, their tops at the sheet's first row, with a column between them."""

    picture: Image
    """(rows, columns, 3) uint8, both numbers even."""
    image: IntArray
    """(columns,) int64, the image that each column is of."""
    color: Image
    """(columns,) uint8, the color that it serves; NO_COLOR where panels meet."""
    height: IntArray
    """(columns,) rows in use."""
    shift: IntArray
    """(2, columns) what takes a column, and the rows in it, to the halved image."""
    scale: IntArray
    """(columns,) pixels of the image that one of the sheet spans."""


def pack_windows(images: Sequence[Image], windows: Sequence[Window]) -> Atlas:
    """Cut windows out of images and lay them side by side.

    Args:
        images: (rows, columns, 3), all of one size.
        windows: what to cut out, at least one; each overlaps its image.
    """
    height = _even(max(window.bottom - window.top for window in windows))
    width = _even(sum(window.right - window.left + 1 for window in windows))
    picture = np.zeros((height, width, 3), dtype=np.uint8)
    color = np.full(width, NO_COLOR, dtype=np.uint8)
    image, used = np.zeros((2, width), dtype=np.int64)
    shift, scale = np.zeros((2, width), dtype=np.int64), np.ones(width, dtype=np.int64)
    start = 0
    for window in windows:
        columns, rows = window.right - window.left, window.bottom - window.top
        end = start + columns
        picture[:, start : end + 1] = _cut(images[window.image], window, height)
        # Smoothing mixes the first column with the panel to its left.
        color[start + 1 : end] = window.color
        panel = slice(start, end + 1)
        image[panel], used[panel], scale[panel] = window.image, rows, 1 << window.times
        shift[0, panel], shift[1, panel] = window.left - start, window.top
        start = end + 1
    return Atlas(picture, image, color, used, shift, scale)


def _cut(image: Image, window: Window, height: int) -> Image:
    """Return a window of an image, extended to a height and by a column; all beyond repeats the border."""
    _, times, _, left, top, right, bottom = window
    rows, columns = image.shape[0] >> times, image.shape[1] >> times
    a, b, c, d = max(left, 0), max(top, 0), min(right, columns), min(bottom, rows)
    cut = measuring_image(image[b << times : d << times, a << times : c << times], times)
    around = (b - top, top + height - d, a - left, right + 1 - c)
    return np.asarray(cv2.copyMakeBorder(cut, *around, cv2.BORDER_REPLICATE), dtype=np.uint8)


def _even(number: int) -> int:
    return number + number % 2
