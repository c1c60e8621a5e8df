"""Outlines of image regions, for drawing: of ellipses with given moments, and of masks."""

import cv2
import numpy as np
from numpy.typing import ArrayLike

from ...arrays import Array, SingleArray

CORNERS = 32
SUBSAMPLES = 2
"""Sample points a pixel along either axis, on which the edge of half coverage is found."""


def ellipse_outline(centroid: ArrayLike, second_moment: ArrayLike, corners: int = CORNERS) -> Array:
    """Closed outlines of the uniform ellipses with given moments.

    Args:
        centroid: (..., 2) [px].
        second_moment: (..., 2, 2) second central moment matrices [px²].
        corners: Corners K of each outline; the last joins the first.

    Returns:
        (..., K, 2) [px]; NaN where the moments are.
    """
    center = np.asarray(centroid, dtype=np.float64)
    moments = np.asarray(second_moment, dtype=np.float64)
    known = np.isfinite(center).all(-1) & np.isfinite(moments).all((-1, -2))
    values, axes = np.linalg.eigh(np.where(known[..., None, None], moments, np.eye(2)))
    # The second moments of a uniform ellipse are a quarter of its squared half-axes.
    half_axes = 2.0 * np.sqrt(np.maximum(values, 0.0))
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    around = (circle * half_axes[..., None, :]) @ np.swapaxes(axes, -1, -2)
    return np.asarray(np.where(known[..., None, None], center[..., None, :] + around, np.nan))


def mask_outlines(mask: SingleArray, scale: float) -> list[Array]:
    """Outlines of the area that a mask covers at least half, the longest first.

    Args:
        mask: (rows, columns) coverage in 0..1.
        scale: Pixels of the image to one of the mask.

    Returns:
        Closed outlines (N, 2) in pixels of the image.
    """
    fine = cv2.resize(mask, None, fx=SUBSAMPLES, fy=SUBSAMPLES, interpolation=cv2.INTER_LINEAR)
    inside = (np.asarray(fine) >= 0.5).view(np.uint8)
    found, _ = cv2.findContours(inside, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)
    # OpenCV follows the centers of the outermost points that are inside.
    outlines = [(contour[:, 0] + 0.5) * (scale / SUBSAMPLES) for contour in found if len(contour) > 2]
    return sorted(outlines, key=len, reverse=True)
