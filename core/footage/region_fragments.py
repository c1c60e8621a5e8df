"""Joining the fragments of a marker's region, and the quality of the result."""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import percentile_filter

from ..arrays import Array, BoolArray, IntArray
from .association import Candidates

AREA_WINDOW = 31
"""Window in frames for a marker's full area; the marker turns and approaches more slowly."""
CLIPPED_QUALITY = 0.4


class MarkerRegion(NamedTuple):
    """A marker's joined region in each of F frames."""

    moments: Array
    """(F, 6) raw moments, zero where hidden."""
    clipped: BoolArray
    """(F,) whether it touches the image's border."""
    certainty: Array
    """(F,) certainty of its color, in 0..1."""
    share: Array
    """(F,) share of its main fragment in its area."""


def join_fragments(
    found: Candidates, path: IntArray, cost: Array, reach_px: float, most_cost: float
) -> MarkerRegion:
    """Join each frame's main region with the fragments that an occluding limb cut off from it.

    Args:
        found: The marker's regions.
        path: (F,) main region of each frame, -1 where hidden.
        cost: (N,) cost of each region; too costly ones are clutter.
        reach_px: Widest gap between a fragment and the main region.
        most_cost: Highest cost of a fragment.
    """
    frames = len(path)
    main = path[found.frame]  # (N,) of each region, the main one of its frame
    gap = np.where(main >= 0, _box_gap(found.box, found.box[main]), np.inf)
    taken = np.flatnonzero((main == np.arange(len(main))) | ((gap <= reach_px) & (cost <= most_cost)))
    frame = found.frame[taken]
    moments, clipped = np.zeros((frames, 6)), np.zeros(frames, dtype=np.bool_)
    np.add.at(moments, frame, found.moments[taken])
    np.logical_or.at(clipped, frame, found.clipped[taken])
    area = np.where(moments[:, 0] > 0.0, moments[:, 0], 1.0)
    certainty = np.bincount(frame, found.certainty[taken] * found.area[taken], minlength=frames) / area
    share = np.zeros(frames)
    seen = np.flatnonzero(path >= 0)
    share[seen] = found.area[path[seen]] / area[seen]
    return MarkerRegion(moments, clipped, certainty, share)


def region_quality(own: MarkerRegion) -> Array:
    """Quality of each region as the whole marker, (F,) in 0..1; 0 where hidden.

    The product of four factors: area relative to the full area in the frames around, clipping by the image's
    border, certainty of the color, and fragmentation.
    """
    area = own.moments[:, 0]
    if not np.any(area > 0.0):
        return np.zeros(len(area))
    seen = area > 0.0
    full = np.zeros(len(area))
    full[seen] = percentile_filter(area[seen], 80, size=min(AREA_WINDOW, int(seen.sum())), mode="nearest")
    ratio = np.where(seen, area, 1.0) / np.where(seen, full, 1.0)
    whole = np.minimum(np.minimum(ratio, 1.5 / ratio), 1.0)
    quality = whole * own.certainty * (0.5 + 0.5 * own.share) * np.where(own.clipped, CLIPPED_QUALITY, 1.0)
    return np.where(seen, np.clip(quality, 0.0, 1.0), 0.0)


def _box_gap(box: Array, other: Array) -> Array:
    """Distances between boxes (N, 4) and others (N, 4)."""
    across = np.maximum(other[:, 0] - box[:, 2], box[:, 0] - other[:, 2])
    down = np.maximum(other[:, 1] - box[:, 3], box[:, 1] - other[:, 3])
    return np.asarray(np.hypot(np.maximum(across, 0.0), np.maximum(down, 0.0)))
