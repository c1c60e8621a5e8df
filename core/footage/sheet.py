"""Windows of a picture laid side by side on one sheet, so that every step of the work is done once for all.

Each panel of the sheet serves one marker. Where a window reaches beyond the picture, the picture's border is
repeated, so that it is no edge of a region that it cuts.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from .working_image import measuring_image

Image = NDArray[np.uint8]

NO_COLOUR = 254
"""Colour of the columns between panels; no pixel bears it."""


class Window(NamedTuple):
    """A part of the measuring grid in which a colour is looked for, in its pixels."""

    colour: int
    left: int
    top: int
    right: int
    bottom: int


class Sheet(NamedTuple):
    """Windows side by side, their tops at the sheet's first row, with an empty column after each; even numbers of rows and columns.

    Attributes:
        image: (rows, columns, 3) uint8.
        colour: (columns,) uint8, the colour that each column serves; NO_COLOUR in empty ones.
        height: (columns,) rows in use.
        shift: (2, columns) what takes a column, and the rows in it, to the measuring grid.
    """

    image: Image
    colour: NDArray[np.uint8]
    height: NDArray[np.int64]
    shift: NDArray[np.int64]


def lay_out(image: Image, times: int, windows: Sequence[Window]) -> Sheet:
    """Cut windows out of an image and lay them side by side.

    Args:
        image: (rows, columns, 3), to be halved `times` to become the measuring grid.
        times: how often.
        windows: what to cut out, at least one; each overlaps the image.
    """
    rows, columns = image.shape[0] >> times, image.shape[1] >> times
    height = _even(max(window.bottom - window.top for window in windows))
    width = _even(sum(window.right - window.left + 1 for window in windows))
    sheet = np.zeros((height, width, 3), dtype=np.uint8)
    served = np.full(width, NO_COLOUR, dtype=np.uint8)
    used, shift = np.zeros(width, dtype=np.int64), np.zeros((2, width), dtype=np.int64)
    start = 0
    for colour, left, top, right, bottom in windows:
        a, b, c, d = max(left, 0), max(top, 0), min(right, columns), min(bottom, rows)
        cut = measuring_image(image[b << times : d << times, a << times : c << times], times)
        if (a, b, c, d) != (left, top, right, bottom):
            cut = cv2.copyMakeBorder(cut, b - top, bottom - d, a - left, right - c, cv2.BORDER_REPLICATE)
        end = start + right - left
        sheet[: bottom - top, start:end] = cut
        served[start:end] = colour
        used[start:end] = bottom - top
        shift[0, start:end], shift[1, start:end] = left - start, top
        start = end + 1
    return Sheet(sheet, served, used, shift)


def _even(number: int) -> int:
    return number + number % 2
