"""Outlines of a mask, for drawing it over the footage."""

import cv2
import numpy as np

from ...arrays import Array, SingleArray

FINENESS = 2
"""Points of a pixel and axis that the edge of half coverage is found on."""


def mask_outlines(mask: SingleArray, scale: float) -> list[Array]:
    """Return the outlines of what a mask covers at least half, the longest first.

    Args:
        mask: (rows, columns) coverage in 0..1.
        scale: pixels of the image that one of the mask spans.

    Returns:
        Closed outlines (N, 2) in pixels of the image.
    """
    fine = cv2.resize(mask, None, fx=FINENESS, fy=FINENESS, interpolation=cv2.INTER_LINEAR)
    inside = (np.asarray(fine) >= 0.5).view(np.uint8)
    found, _ = cv2.findContours(inside, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)
    # OpenCV follows the centers of the outermost points that are inside.
    outlines = [(contour[:, 0] + 0.5) * (scale / FINENESS) for contour in found if len(contour) > 2]
    return sorted(outlines, key=len, reverse=True)
