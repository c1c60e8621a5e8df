"""Assignment of detected regions to markers, for tracking and for the marker check."""

from collections.abc import Callable, Sequence

import numpy as np

from ..arrays import Array, BoolArray, IntArray
from .association import Candidates, region_costs, rival_costs, static_clutter, typical_area
from .region_fragments import MarkerRegion, join_fragments
from .region_tracks import ExpectedRegions
from .segmentation.moments import centroid_and_second_moment

HIGHEST_FRAGMENT_COST = 10.0
"""Highest cost of a region that counts as a fragment of a marker."""


def assign_regions(
    found: Sequence[Candidates],
    groups: Sequence[Sequence[int]],
    expected: ExpectedRegions | None,
    choose: Callable[[Candidates, Array, float], IntArray],
) -> dict[int, MarkerRegion]:
    """Assign regions to markers in every frame; return each marker's by its index.

    Args:
        found: The regions of each color.
        groups: The markers of each color.
        expected: Expected regions of the markers.
        choose: Function of a color's regions, their costs (N,) and the marker's length in px that gives the
            index of its main region in each frame (F,), -1 where it is hidden.
    """
    alone = [len(group) == 1 for group in groups]
    clutter = [
        static_clutter(one) if single else np.zeros(len(one.frame), dtype=np.bool_)
        for one, single in zip(found, alone, strict=True)
    ]
    usual = [typical_area(one, still) for one, still in zip(found, clutter, strict=True)]
    reach = 0.5 * float(np.sqrt(max(usual, default=0.0)))  # about the width of a limb that covers a marker
    own = {}
    for color, group in enumerate(groups):
        one = found[color]
        length = _length(one, clutter[color], usual[color])
        taken = np.zeros(len(one.frame), dtype=np.bool_)
        for marker in group:
            cost = region_costs(one, clutter[color], usual[color], expected, marker)
            cost += rival_costs(one, taken, expected, marker, [other for other in group if other != marker])
            path = choose(one, cost, length)
            own[marker] = join_fragments(one, path, cost, reach, HIGHEST_FRAGMENT_COST)
            taken[path[path >= 0]] = True
    return own


def _length(found: Candidates, clutter: BoolArray, usual_area: float) -> float:
    """The marker's length in px: the long axis of regions of the usual size."""
    full = ~clutter & (found.area >= 0.7 * usual_area)
    if not full.any():
        return 1.0
    _, second = centroid_and_second_moment(found.moments[full])
    return float(np.median(np.sqrt(12.0 * np.linalg.eigvalsh(second)[:, 1])))
