"""The picture's edge: the share of each sample of a silhouette that lies within the picture.

A limb that leaves the picture is seen in part, and the centroid of what is seen moves less than the limb. The
edge cuts the cell that a sample stands for, so that shares and their slopes change smoothly.
"""

from typing import NamedTuple

import numpy as np

from ..arrays import Array, BoolArray

SMALLEST_CELL_PX = 1.0
SMALLEST_SHARE = 1e-6


class EdgeCut(NamedTuple):
    """What the picture's edge leaves of samples (...)."""

    share: Array
    """(...) share within the picture, 0 to 1."""
    slope: Array
    """(..., 2) d log share / d pixel [1/px]; zero where all or nothing is left."""


def near_edge(pixels: Array, area: Array, size: tuple[int, int]) -> BoolArray:
    """(F, Q) which pieces the edge of a picture (columns, rows) cuts, or leaves out.

    Args:
        pixels: (F, Q, S, 2) the pieces' samples.
        area: (F, Q, S) of the cells they stand for [px²].
        size: Columns and rows.
    """
    reach = 0.5 * np.sqrt(np.maximum(area.max(axis=-1), SMALLEST_CELL_PX**2))
    outside = np.zeros(area.shape[:2], dtype=np.bool_)
    for axis in (0, 1):
        along = pixels[..., axis]
        outside |= (along.min(axis=-1) < reach) | (along.max(axis=-1) > size[axis] - reach)
    return outside


def edge_cut(pixels: Array, area: Array, size: tuple[int, int]) -> EdgeCut:
    """What the edge of a picture leaves of square cells.

    Args:
        pixels: (..., 2) their centers [px].
        area: (...) [px²].
        size: Columns and rows of the picture.
    """
    side = np.sqrt(np.maximum(area, SMALLEST_CELL_PX**2))
    share, slope = np.ones(area.shape), np.zeros(pixels.shape)
    for axis in (0, 1):
        along = pixels[..., axis]
        for away, sign in ((along, 1.0), (size[axis] - along, -1.0)):
            within = np.clip(0.5 + away / side, 0.0, 1.0)
            cut = (within > SMALLEST_SHARE) & (within < 1.0)
            slope[..., axis] += np.where(cut, sign / (side * np.maximum(within, SMALLEST_SHARE)), 0.0)
            share = share * within
    return EdgeCut(share, np.where(share[..., None] > 0.0, slope, 0.0))
