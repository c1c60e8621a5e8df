"""Which regions are the marker: one path through a whole clip's regions, and the pieces that belong to it.

All regions of a marker's colour are recorded in one pass over the clip as a few numbers each. The path is
then the cheapest one through them: it pays for jumps, for regions unlike the marker, and for frames in which
it is hidden. Costs are negative logarithms of likelihood ratios.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from .regions import Region

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

_HIDING_COST: Final = 4.0
"""Cost of hiding at all: a marker seen a moment ago is seen again in 98 of 100 frames."""
_HIDDEN_COST: Final = 2.5
"""Cost of each hidden frame: once hidden, a marker stays so for a while."""
_CERTAINTY_WEIGHT: Final = 3.0
"""A region's pixels err together, but less than fully: its colour counts as a few independent witnesses."""
_RESTART_COST: Final = 10.0
_LONGEST_GAP: Final = 12
"""Frames over which the speed still bounds where a marker comes back."""
_AREA_DEVIATION: Final = 1.2
"""Of the logarithm: foreshortening and occlusion change a region's area by a factor of three and more."""
_STEP_IN_SIZES: Final = 0.35
"""Standard deviation of a step between frames, in sizes of the marker: limbs move their own size in 0.1 s."""
_STILL_SHARE: Final = 0.5
_STILL_STEP_PX: Final = 1.5
_STILL_LOG_AREA: Final = 0.4
_STILL_COST: Final = 20.0
_RIVAL_SHARE: Final = 0.25
_RIVAL_AREA: Final = 0.1
"""A moving region of a tenth of a still one's area is no speck of noise beside it."""


@dataclass(frozen=True, eq=False)
class Candidates:
    """The regions of one marker's colour over a clip, N in all.

    Attributes:
        frame: (N,) frame index of each, ascending.
        moments: (N, 6) raw moments.
        box: (N, 4) left, top, right, bottom in px.
        certainty: (N,) colour certainty in 0..1.
        clipped: (N,) whether it touches the image's border.
        start: (F + 1,) where each frame's regions begin.
    """

    frame: IntArray
    moments: FloatArray
    box: FloatArray
    certainty: FloatArray
    clipped: BoolArray
    start: IntArray

    @property
    def centroid(self) -> FloatArray:
        """Centroids, (N, 2) px."""
        return np.asarray(self.moments[:, 1:3] / self.moments[:, :1])

    @property
    def area(self) -> FloatArray:
        """Areas, (N,) px."""
        return np.asarray(self.moments[:, 0])


def candidates(regions: Sequence[Sequence[Region]]) -> Candidates:
    """Gather one marker's regions, one sequence a frame."""
    counts = np.array([len(row) for row in regions], dtype=np.int64)
    flat = [region for row in regions for region in row]
    return Candidates(
        frame=np.repeat(np.arange(len(regions)), counts),
        moments=np.array([region.moments for region in flat]).reshape(-1, 6),
        box=np.array([region.box for region in flat]).reshape(-1, 4),
        certainty=np.array([region.certainty for region in flat], dtype=np.float64),
        clipped=np.array([region.clipped for region in flat], dtype=np.bool_),
        start=np.concatenate([[0], np.cumsum(counts)]),
    )


def typical_area(found: Candidates, clutter: BoolArray) -> float:
    """Return the usual area in px of a frame's largest region that is not clutter; 0 without any."""
    largest = np.zeros(len(found.start) - 1)
    np.maximum.at(largest, found.frame, np.where(clutter, 0.0, found.area))
    return float(np.median(largest[largest > 0.0])) if np.any(largest > 0.0) else 0.0


def still_clutter(found: Candidates) -> BoolArray:
    """Mark regions (N,) that stay in place for most of the clip while others of their colour move.

    A marker that itself rests is not marked: nothing else of its colour is seen at the same time.
    """
    frames = len(found.start) - 1
    still = _still(found, frames)
    if not still.any():
        return still
    rest = float(np.median(found.area[still]))
    with_still = np.zeros(frames, dtype=np.bool_)
    with_still[found.frame[still]] = True
    rival = ~still & with_still[found.frame] & (found.area >= _RIVAL_AREA * rest)
    rivals = len(np.unique(found.frame[rival]))
    return still if rivals >= _RIVAL_SHARE * frames else np.zeros_like(still)


def _still(found: Candidates, frames: int) -> BoolArray:
    """Mark regions with like ones at their place in most frames."""
    still = np.zeros(len(found.frame), dtype=np.bool_)
    centroid, log_area = found.centroid, np.log(found.area)
    order = np.argsort(centroid[:, 0])
    column = centroid[order, 0]
    for index in range(len(found.frame)):
        first = np.searchsorted(column, centroid[index, 0] - _STILL_STEP_PX)
        last = np.searchsorted(column, centroid[index, 0] + _STILL_STEP_PX)
        beside = order[first:last]
        near = np.abs(centroid[beside, 1] - centroid[index, 1]) <= _STILL_STEP_PX
        near &= np.abs(log_area[beside] - log_area[index]) < _STILL_LOG_AREA
        still[index] = len(np.unique(found.frame[beside[near]])) >= _STILL_SHARE * frames
    return still


def main_path(found: Candidates, unary: FloatArray, size_px: float) -> IntArray:
    """Return the index of the marker's main region in each frame, (F,); -1 where it is hidden.

    Args:
        found: the regions.
        unary: (N,) cost of taking each region for the marker.
        size_px: length of the marker, the measure of its steps.
    """
    total = np.full(len(found.frame), np.inf)
    previous = np.full(len(found.frame), -1, dtype=np.int64)
    centroid = found.centroid
    frames = len(found.start) - 1
    best_before, best_index = 0.0, -1  # the cheapest path so far plus its hidden frames, and where it ended
    for frame in range(frames):
        here = slice(int(found.start[frame]), int(found.start[frame + 1]))
        if here.stop > here.start:
            first = int(found.start[max(frame - _LONGEST_GAP, 0)])
            restart = best_before + (_RESTART_COST if best_index >= 0 else 0.0)
            cost = np.full(here.stop - here.start, restart)
            source = np.full(here.stop - here.start, best_index)
            if here.start > first:
                gap = frame - found.frame[first : here.start]
                step = np.linalg.norm(centroid[here, None] - centroid[None, first : here.start], axis=-1)
                through = total[first : here.start] + _HIDDEN_COST * (gap - 1) + _HIDING_COST * (gap > 1)
                through = through + 0.5 * (step / (_STEP_IN_SIZES * size_px * gap)) ** 2
                nearest = np.argmin(through, axis=1)
                cheaper = through[np.arange(len(nearest)), nearest] < cost
                cost = np.where(cheaper, through[np.arange(len(nearest)), nearest], cost)
                source = np.where(cheaper, nearest + first, source)
            total[here] = cost + unary[here]
            previous[here] = source
        best_before += _HIDDEN_COST
        if here.stop > here.start and total[here].min() < best_before:
            best_before, best_index = float(total[here].min()), int(here.start + np.argmin(total[here]))
    path = np.full(frames, -1, dtype=np.int64)
    while best_index >= 0:
        path[found.frame[best_index]] = best_index
        best_index = int(previous[best_index])
    return path


def region_costs(
    found: Candidates,
    clutter: BoolArray,
    usual_area: float,
    expected_centre: FloatArray | None,
    expected_radius: FloatArray | None,
) -> FloatArray:
    """Return the cost of taking each region for the marker, (N,), by area, colour, rest and expected place.

    Args:
        found: the regions.
        clutter: (N,) regions known to be none of the marker.
        usual_area: area of the marker in px.
        expected_centre: (F, 2) px or None.
        expected_radius: (F,) px or None.
    """
    if not len(found.frame):
        return np.zeros(0)
    cost = 0.5 * (np.log(found.area / usual_area) / _AREA_DEVIATION) ** 2
    cost -= _CERTAINTY_WEIGHT * np.log(np.clip(found.certainty, 1e-3, 1.0))
    cost += np.where(clutter, _STILL_COST, 0.0)
    if expected_centre is not None and expected_radius is not None:
        # A container's claimed frame count may fall short: frames beyond it have no expectation.
        known = np.flatnonzero(found.frame < len(expected_centre))
        frame = found.frame[known]
        offset = np.linalg.norm(found.centroid[known] - expected_centre[frame], axis=1)
        relative = offset / np.maximum(expected_radius[frame], 1.0)
        cost[known] += np.nan_to_num(np.minimum(0.5 * (2.0 * relative) ** 2, 2.0 * _RESTART_COST))
    return np.asarray(cost)
