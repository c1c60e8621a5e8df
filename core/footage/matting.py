"""How much of each pixel a region covers: its border to a fraction of a pixel.

A border pixel mixes the region's colour and its surroundings'; encoded colours mix linearly to a good approximation.
The share follows from the colours just inside and just outside, which makes areas unbiased where a threshold would
grow a region over dark neighbours and shrink it before bright ones.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.uint8]

_LUMA_DEVIATION = 3.0
"""Luma varies within a surface by its shading, so it says less about coverage than chroma does."""
_KERNEL = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (3, 3))


def coverage(image: NDArray[np.uint8], mask: Mask, border: int) -> NDArray[np.float32]:
    """Return the share of each pixel that the masked region covers, (rows, columns) in 0..1.

    Args:
        image: (rows, columns, 3) uint8.
        mask: (rows, columns), the region as classified; nonzero inside.
        border: half-width in pixels of the band about the mask's edge that is weighed anew.
    """
    inside = (mask > 0).astype(np.uint8)
    # Reflecting replicates the region beyond a window that cuts it, so that the image's border is no edge of it.
    grown = cv2.dilate(inside, _KERNEL, iterations=border)
    depth = cv2.distanceTransform(
        cv2.copyMakeBorder(inside, 1, 1, 1, 1, cv2.BORDER_REPLICATE), cv2.DIST_L2, 3
    )
    depth = depth[1:-1, 1:-1]
    colour = cv2.cvtColor(image, cv2.COLOR_BGR2YCrCb).astype(np.float32)
    colour[..., 0] /= _LUMA_DEVIATION
    size = 4 * border + 3
    foreground, has_foreground = _local_mean(colour, depth**2, size)
    background, has_background = _local_mean(colour, (1 - grown).astype(np.float32), size)
    axis = foreground - background
    length = _dot(axis, axis)
    share = _dot(colour - background, axis) / np.maximum(length, 1.0)
    share = np.where(has_foreground & has_background, np.clip(share, 0.0, 1.0), inside)
    share[grown == 0] = 0.0
    share[depth > border] = 1.0
    return np.asarray(share, dtype=np.float32)


def _dot(first: NDArray[np.float32], second: NDArray[np.float32]) -> NDArray[np.float32]:
    return np.asarray(cv2.transform(first * second, np.ones((1, 3), dtype=np.float32)), dtype=np.float32)


def _local_mean(
    colour: NDArray[np.float32], weight: NDArray[np.float32], size: int
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    total = cv2.blur(weight, (size, size), borderType=cv2.BORDER_REPLICATE)
    mean = cv2.blur(colour * weight[..., None], (size, size), borderType=cv2.BORDER_REPLICATE)
    known = total > 1e-6
    return mean / np.where(known, total, 1.0)[..., None].astype(np.float32), known
