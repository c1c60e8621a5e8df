"""Search windows: boxes around the pixels of the markers' colors on a coarse grid."""

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from ..arrays import BoolArray, Image, IntArray
from ..video.working_image import measuring_image
from .ignored_regions import is_ignored

Box = tuple[int, int, int, int]

MOST_BOXES = 12  # most boxes kept of each color in a frame, those with most pixels of it
MARGIN = 6  # margin in px around a measured box: the border band, and enough background to know its color


def colored_boxes(label: Image, color: int, factor: int) -> list[Box]:
    """Boxes around a color's components on a grid `factor` as coarse as the measuring one, in its pixels."""
    mask = np.equal(label, color).view(np.uint8)
    x, y, columns, rows = cv2.boundingRect(mask)
    if not columns:
        return []
    part = np.ascontiguousarray(mask[y : y + rows, x : x + columns])
    _, _, stats, _ = cv2.connectedComponentsWithStats(part, connectivity=8, ltype=cv2.CV_16U)
    stats = stats[1:]
    if len(stats) > MOST_BOXES:
        stats = stats[np.argsort(-stats[:, cv2.CC_STAT_AREA], kind="stable")[:MOST_BOXES]]
    return [
        ((x + a) * factor, (y + b) * factor, (x + a + c) * factor, (y + b + d) * factor)
        for a, b, c, d, _ in stats.tolist()
    ]


def boxes_to_measure(seen: Sequence[Box], followed: Sequence[Box]) -> list[Box]:
    """Boxes seen, and those of the frame before that none of them shows, too small for the coarse grid.

    Those that overlap with their margins are merged: no pixel is measured twice for a color.
    """
    pending = list(seen) + [box for box in followed if not any(_overlap(box, other, 0) for other in seen)]
    boxes = []
    while pending:
        a, b, c, d = pending.pop()
        for other in pending:
            if _overlap((a, b, c, d), other, 2 * MARGIN):
                pending.remove(other)
                pending.append((min(a, other[0]), min(b, other[1]), max(c, other[2]), max(d, other[3])))
                break
        else:
            boxes.append((a, b, c, d))
    return boxes


def _overlap(first: Box, second: Box, gap: int) -> bool:
    across = first[0] - gap < second[2] and second[0] < first[2] + gap
    return across and first[1] - gap < second[3] and second[1] < first[3] + gap


NO_COLOR = 254  # color index of the columns between panels; no pixel has it


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

    picture: Image  # (rows, columns, 3) uint8, rows and columns even
    image: IntArray  # (columns,) int64, index of each column's image
    color: Image  # (columns,) uint8, index of the color to search for; NO_COLOR between panels
    height: IntArray  # (columns,) rows in use
    shift: IntArray  # (2, columns) offset of a column, and of its rows, to the halved image
    scale: IntArray  # (columns,) pixels of the image to one of the atlas
    ignored: BoolArray | None = None  # (rows, columns) pixels that are no region's; None where there are none


def pack_windows(
    images: Sequence[Image], windows: Sequence[Window], masks: Sequence[Image | None] = ()
) -> Atlas:
    """Cut windows out of images of one size and of the masks of their ignored pixels; lay them side by side.

    The masks are of images halved as the windows are; empty for none. Each window overlaps its image.
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
