"""How much of each pixel a region covers: its border to a fraction of a pixel.

A border pixel mixes the region's colour and its surroundings'; encoded colours mix linearly to a good
approximation. The share follows from the colours just inside and just outside, which makes areas unbiased
where a threshold would grow a region over dark neighbours and shrink it before bright ones.
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
    # Reflecting replicates the region beyond a window that cuts it, so that the image's border is no edge of
    # it.
    grown = cv2.dilate(inside, _KERNEL, iterations=border)
    depth = cv2.distanceTransform(
        cv2.copyMakeBorder(inside, 1, 1, 1, 1, cv2.BORDER_REPLICATE), cv2.DIST_L2, 3
    )
    depth = depth[1:-1, 1:-1]
    colour = cv2.cvtColor(image, cv2.COLOR_BGR2YCrCb)
    planes = [np.asarray(plane, dtype=np.float32) for plane in cv2.split(colour)]
    planes[0] /= _LUMA_DEVIATION
    size = 4 * border + 3
    foreground, has_foreground = _local_mean(planes, depth * depth, size)
    background, has_background = _local_mean(planes, (1 - grown).astype(np.float32), size)
    along = np.zeros(mask.shape, dtype=np.float32)
    length = np.ones(mask.shape, dtype=np.float32)  # one squared level, below which two colours are the same
    for plane, front, back in zip(planes, foreground, background, strict=True):
        axis = front - back
        along += (plane - back) * axis
        length += axis * axis
    share = along / length
    share = np.where(has_foreground & has_background, np.clip(share, 0.0, 1.0), inside)
    share[grown == 0] = 0.0
    share[depth > border] = 1.0
    return np.asarray(share, dtype=np.float32)


def _local_mean(
    planes: list[NDArray[np.float32]], weight: NDArray[np.float32], size: int
) -> tuple[list[NDArray[np.float32]], NDArray[np.bool_]]:
    """Return each plane's weighted mean about each pixel, and where there was any weight."""
    total = cv2.blur(weight, (size, size), borderType=cv2.BORDER_REPLICATE)
    known = total > 1e-6
    inverse = np.where(known, 1.0 / np.maximum(total, 1e-6), 0.0).astype(np.float32)
    means = [cv2.blur(p * weight, (size, size), borderType=cv2.BORDER_REPLICATE) * inverse for p in planes]
    return [np.asarray(mean, dtype=np.float32) for mean in means], known
