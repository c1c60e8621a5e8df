"""The grid that markers are looked for on, and the light smoothing that all colour decisions share."""

from __future__ import annotations

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]

_WORKING_WIDTH: Final = 400
"""Columns that are plenty to find markers by; their regions are then measured on the full grid."""


def reduction(size: tuple[int, int]) -> int:
    """Return the whole factor by which an image of (width, height) is reduced for finding markers."""
    return max(1, round(max(size) / _WORKING_WIDTH))


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
