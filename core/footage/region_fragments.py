"""Putting a marker's pieces together, and saying how far the result can be trusted."""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import percentile_filter

from ..arrays import Array, BoolArray, IntArray
from .association import Candidates

AREA_WINDOW = 31
"""Frames about each in which the marker's full area is looked for: it turns and comes nearer more slowly."""
CLIPPED_QUALITY = 0.4


class MarkerRegion(NamedTuple):
    """What of the regions of its color is a marker's, in each of F frames."""

    moments: Array
    """(F, 6) raw moments, zero where hidden."""
    clipped: BoolArray
    """(F,) whether it touches the image's border."""
    certainty: Array
    """(F,) of its color, in 0..1."""
    share: Array
    """(F,) share of its largest piece in its area."""


def join_fragments(
    found: Candidates, path: IntArray, cost: Array, reach_px: float, most_cost: float
) -> MarkerRegion:
    """Add to each frame's main region the pieces that an arm before the marker cut off from it.

    Args:
        found: the marker's regions.
        path: (F,) main region of each frame, -1 where hidden.
        cost: (N,) cost of each region; too costly ones are clutter.
        reach_px: widest gap between a piece and the main region.
        most_cost: highest cost of a piece.
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
    """Return how far each region can be trusted to be the whole marker, (F,) in 0..1; 0 where hidden.

    The product of the area against the full area seen in frames around, of clipping by the image's border, of
    the color's certainty, and of the scatter of its pieces.
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
    """Return the distances between boxes (N, 4) and others (N, 4)."""
    across = np.maximum(other[:, 0] - box[:, 2], box[:, 0] - other[:, 2])
    down = np.maximum(other[:, 1] - box[:, 3], box[:, 1] - other[:, 3])
    return np.asarray(np.hypot(np.maximum(across, 0.0), np.maximum(down, 0.0)))
