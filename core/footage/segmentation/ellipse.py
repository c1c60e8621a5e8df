"""The outline of a region known by its moments: the even ellipse that has them."""

import numpy as np
from numpy.typing import ArrayLike

from ...arrays import Array

CORNERS = 32


def ellipse_outline(centroid: ArrayLike, second_moment: ArrayLike, corners: int = CORNERS) -> Array:
    """Closed outlines of the even ellipses with given moments.

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
    # An even ellipse has a quarter of its squared half-axes as second moments.
    half_axes = 2.0 * np.sqrt(np.maximum(values, 0.0))
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    around = (circle * half_axes[..., None, :]) @ np.swapaxes(axes, -1, -2)
    return np.asarray(np.where(known[..., None, None], center[..., None, :] + around, np.nan))
