"""How much of each pixel a region covers: its border to a fraction of a pixel.

A border pixel mixes the region's colour and its surroundings'; encoded colours mix linearly to a good
approximation. The share follows from the colours just inside and just outside, which makes areas unbiased
where a threshold would grow a region over dark neighbours and shrink it before bright ones.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

_LUMA_DEVIATION = 3.0
"""Luma varies within a surface by its shading, so it says less about coverage than chroma does."""
_SUM = np.ones((1, 3), dtype=np.float32)
_KERNEL = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (3, 3))


def coverage(image: NDArray[np.uint8], mask: NDArray[np.bool_], border: int) -> NDArray[np.float32]:
    """Return the share of each pixel that the masked region covers, (rows, columns) in 0..1.

    Args:
        image: (rows, columns, 3) uint8.
        mask: (rows, columns), the region as classified.
        border: half-width in pixels of the band about the mask's edge that is weighed anew.
    """
    inside = mask.view(np.uint8)
    # Reflecting replicates the region beyond a window that cuts it, so that the image's border is no edge of
    # it.
    grown = cv2.dilate(inside, _KERNEL, iterations=border)
    depth = cv2.distanceTransform(
        cv2.copyMakeBorder(inside, 1, 1, 1, 1, cv2.BORDER_REPLICATE), cv2.DIST_L2, 3
    )
    depth = depth[1:-1, 1:-1]
    colour = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2YCrCb), dtype=np.float32)
    colour[..., 0] /= _LUMA_DEVIATION
    size = 4 * border + 3
    foreground, has_foreground = _local_mean(colour, depth * depth, size)
    background, has_background = _local_mean(colour, (1 - grown).astype(np.float32), size)
    axis = cv2.subtract(foreground, background)
    along = cv2.transform(cv2.multiply(cv2.subtract(colour, background), axis), _SUM)
    length = cv2.transform(cv2.multiply(axis, axis), _SUM) + 1.0  # one squared level: less is the same colour
    mixed = has_foreground & has_background & (grown > 0) & (depth <= border)
    return np.where(mixed, np.minimum(np.maximum(along / length, 0.0), 1.0), inside).astype(np.float32)


def _local_mean(
    colour: NDArray[np.float32], weight: NDArray[np.float32], size: int
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """Return the weighted mean colour about each pixel, and where there was any weight."""
    weighted = cv2.multiply(colour, cv2.merge([weight, weight, weight]))
    total = cv2.blur(weight, (size, size), borderType=cv2.BORDER_REPLICATE)
    known = total > 1e-6
    divisor = np.maximum(total, 1e-6)
    mean = cv2.blur(weighted, (size, size), borderType=cv2.BORDER_REPLICATE)
    mean = cv2.divide(mean, cv2.merge([divisor, divisor, divisor]))
    return np.asarray(mean, dtype=np.float32), known
