"""Window atlas: the search windows of some images, packed into one image for vectorized segmentation.

Each panel of the atlas serves one color. Where a window reaches beyond its image, the image's border is
repeated, so that it makes no edge of a region that it cuts.
"""

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from ...arrays import BoolArray, Image, IntArray
from ..ignored_regions import is_ignored
from .working_image import measuring_image

NO_COLOR = 254
"""Color index of the columns between panels; no pixel has it."""


class Window(NamedTuple):
    """A window of an image to search for a color, in pixels of the image halved `times`."""

    image: int
    times: int
    color: int
    left: int
    top: int
    right: int
    bottom: int


class Atlas(NamedTuple):
    """Windows side by side, their tops at the atlas's first row, with a column between them."""

    picture: Image
    """(rows, columns, 3) uint8, rows and columns even."""
    image: IntArray
    """(columns,) int64, index of each column's image."""
    color: Image
    """(columns,) uint8, index of the color to search for; NO_COLOR between panels."""
    height: IntArray
    """(columns,) rows in use."""
    shift: IntArray
    """(2, columns) offset of a column, and of its rows, to the halved image."""
    scale: IntArray
    """(columns,) pixels of the image to one of the atlas."""
    ignored: BoolArray | None = None
    """(rows, columns) pixels that are no region's; None where there are none."""


def pack_windows(
    images: Sequence[Image], windows: Sequence[Window], masks: Sequence[Image | None] = ()
) -> Atlas:
    """Cut windows out of images and lay them side by side.

    Args:
        images: (rows, columns, 3), all of one size.
        windows: What to cut out, at least one; each overlaps its image.
        masks: Of each image, the ignored pixels of the image halved as its windows are; empty for none.
    """
    height = _even(max(window.bottom - window.top for window in windows))
    width = _even(sum(window.right - window.left + 1 for window in windows))
    picture = np.zeros((height, width, 3), dtype=np.uint8)
    color = np.full(width, NO_COLOR, dtype=np.uint8)
    image, used = np.zeros((2, width), dtype=np.int64)
    shift, scale = np.zeros((2, width), dtype=np.int64), np.ones(width, dtype=np.int64)
    ignored = np.zeros((height, width), dtype=np.uint8) if any(mask is not None for mask in masks) else None
    start = 0
    for window in windows:
        columns, rows = window.right - window.left, window.bottom - window.top
        end = start + columns
        picture[:, start : end + 1] = _cut(images[window.image], window, height)
        mask = masks[window.image] if ignored is not None else None
        if ignored is not None and mask is not None:
            ignored[:, start : end + 1] = _cut(mask, window._replace(times=0), height)
        # Smoothing mixes the first column with the panel to its left.
        color[start + 1 : end] = window.color
        panel = slice(start, end + 1)
        image[panel], used[panel], scale[panel] = window.image, rows, 1 << window.times
        shift[0, panel], shift[1, panel] = window.left - start, window.top
        start = end + 1
    hidden = None if ignored is None else is_ignored(ignored)
    return Atlas(picture, image, color, used, shift, scale, hidden)


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
