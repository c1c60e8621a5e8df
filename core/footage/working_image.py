"""The grids that markers are found and measured on, and the light smoothing all colour decisions share."""

from __future__ import annotations

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]

_MEASURING_WIDTH: Final = 640
"""Columns on which borders are measured to a third of a column, finer than any body model predicts them."""
_SEARCHING_WIDTH: Final = 320
"""Columns that are plenty to find markers by."""


def measuring_factor(size: tuple[int, int]) -> int:
    """Return the whole factor by which an image of (width, height) is reduced for measuring regions."""
    return max(1, round(max(size) / _MEASURING_WIDTH))


def searching_factor(size: tuple[int, int]) -> int:
    """Return the further factor by which the measuring grid of (columns, rows) is reduced for the search."""
    return max(1, round(max(size) / _SEARCHING_WIDTH))


def searching_image(image: Image) -> Image:
    """Return an image as it is searched for markers."""
    measuring = reduce(image, measuring_factor((image.shape[1], image.shape[0])))
    return reduce(measuring, searching_factor((measuring.shape[1], measuring.shape[0])))


def reduce(image: Image, factor: int) -> Image:
    """Return every factor-th pixel's neighbourhood; columns and rows that do not fill one are left out."""
    if factor == 1:
        return image
    rows, columns = image.shape[0] // factor, image.shape[1] // factor
    whole = image[: rows * factor, : columns * factor]
    return np.asarray(cv2.resize(whole, (columns, rows), interpolation=cv2.INTER_AREA), dtype=np.uint8)


def smooth(image: Image) -> Image:
    """Average about one pixel to each side: decoders hold chroma at half the resolution of luma anyway."""
    return np.asarray(cv2.GaussianBlur(image, (3, 3), 0.0), dtype=np.uint8)
