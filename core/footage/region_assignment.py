"""Which of the regions of its color are each marker's: what extraction and a look at samples share."""

from collections.abc import Callable, Sequence

import numpy as np

from ..arrays import Array, BoolArray, IntArray
from .association import Candidates, region_costs, rival_costs, static_clutter, typical_area
from .region_fragments import MarkerRegion, join_fragments
from .region_tracks import ExpectedRegions
from .segmentation.moments import centroid_and_second_moment

HIGHEST_FRAGMENT_COST = 10.0
"""Highest cost of what is taken for a piece of a marker."""


def assign_regions(
    found: Sequence[Candidates],
    groups: Sequence[Sequence[int]],
    expected: ExpectedRegions | None,
    choose: Callable[[Candidates, Array, float], IntArray],
) -> dict[int, MarkerRegion]:
    """Return what is each marker's in every frame, by the marker's index.

    Args:
        found: of each color, its regions.
        groups: of each color, the markers that bear it.
        expected: where the markers are expected.
        choose: from a color's regions, their costs (N,) and the marker's length in px, the index of its main
            region in each frame, (F,); -1 where it is hidden.
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
    """Return the marker's length in px: the long axis of regions of the usual size."""
    full = ~clutter & (found.area >= 0.7 * usual_area)
    if not full.any():
        return 1.0
    _, second = centroid_and_second_moment(found.moments[full])
    return float(np.median(np.sqrt(12.0 * np.linalg.eigvalsh(second)[:, 1])))
