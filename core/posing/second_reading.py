"""A second reading of the clip, with the found postures telling where each marker is."""

from dataclasses import replace
from typing import Any

import numpy as np

from ..files.digest import digest
from ..footage.reading import Reading
from ..progress import Job
from ..take.read_footage import read_footage
from ..take.take import Take
from .found_poses import FoundPoses, with_found

ELSEWHERE_SIZES, ELSEWHERE_SHARE = 1.0, 0.15
"""Distance of another region, in sizes, and the share of frames in which a mistaken marker has one."""
WELL_EXPLAINED = 0.9
"""Explained share of the footage above which no marker is taken for mistaken."""
BETTER_BY = 0.04
"""Gain in the explained share for which the second reading is kept."""


def read_again(take: Take, reading: Reading, found: FoundPoses) -> Job[Reading | None]:
    """The clip read again with each marker looked for where it was found; None where nothing changes.

    Without keyframes another thing of a marker's color may have been taken for it. A marker that is merely
    lost in the second reading keeps its first: an arm may do something that no library does.
    """
    if reading.detections is None or found.fit > WELL_EXPLAINED:
        return None
    again = yield from read_footage(with_found(replace(take, keyframes=()), found), reading)
    first, second = reading.tracks, again.tracks
    apart = np.linalg.norm(first.centroid - second.centroid, axis=-1)  # NaN where hidden in either
    elsewhere = (apart > ELSEWHERE_SIZES * np.sqrt(np.nan_to_num(second.area))).mean(axis=0) > ELSEWHERE_SHARE
    if not elsewhere.any():
        return None
    names = ("centroid", "second_moment", "area", "quality", "clipped")
    arrays: dict[str, Any] = {name: np.array(getattr(first, name)) for name in names}
    for name, array in arrays.items():
        array[:, elsewhere] = getattr(second, name)[:, elsewhere]
    # The key names both readings, so that the mixture is recognized.
    footage = again.key.rpartition("-")[0]
    key = f"{footage}-{digest(reading.key, again.key, elsewhere)}" if footage else ""
    return replace(again, tracks=replace(first, **arrays), key=key)


def is_better(second: FoundPoses, first: FoundPoses) -> bool:
    """Whether what was found in a second reading explains so much more that it is kept."""
    return second.fit > first.fit + BETTER_BY
