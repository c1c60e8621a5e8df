"""What contradicts a frame's plausible postures: a region that nobody wears, a limb that none could bend so.

A body can be bent to almost any five regions. So each marker in turn is left out: where the others are then
explained far better, that region is another thing of its color, such as a panel on the wall.
"""

from dataclasses import dataclass

import numpy as np

from ..body.limbs import limb_of
from ..body.posture import Posture
from ..estimate.frame_residuals import frame_residuals
from ..observation.keypoints import JOINT_ERROR_STD_M, USUAL_PLACES
from .frame_search import Hypotheses, Knowledge, search
from .frame_shown import FrameShown
from .known_postures import PARTS

UNWORN_COST = 12.0
"""Cost of a region that nobody wears: one marker in twenty, at one of some ten thousand places and sizes that
can be told apart in a picture."""
KEYPOINT_COST = 0.5
"""What a keypoint costs where the posture is right, its guessed depth included: no gain of leaving a
marker out."""
FEW_STARTS = 24
"""Starts of a search without a marker, which only asks how well the rest can be explained."""


@dataclass(frozen=True, eq=False)
class Unworn:
    """A region that nobody wears."""

    name: str
    """Its marker."""
    shown: FrameShown
    """The frame without it."""


def unworn_marker(
    known: Knowledge, shown: FrameShown, found: Hypotheses, floor_m: float | None
) -> Unworn | None:
    """The marker without which the rest of the frame is explained far better; None where there is none."""
    least = float(found.cost.min())
    visible = np.flatnonzero(shown.tracks.visible[0])
    # Nothing is left to gain where all is well explained.
    alone = len(visible) + int(shown.points.seen.sum()) < 2
    if least < UNWORN_COST + KEYPOINT_COST * shown.points.seen.sum() or alone or not len(visible):
        return None
    rest = {int(marker): shown.without(int(marker)) for marker in visible}
    gains = {
        marker: least - float(search(known, one, floor_m, FEW_STARTS).cost.min())
        for marker, one in rest.items()
    }
    best = max(gains, key=lambda marker: gains[marker])
    if gains[best] < UNWORN_COST:
        return None
    return Unworn(shown.tracks.names[best], rest[best])


def unexplained(known: Knowledge, shown: FrameShown, posture: Posture) -> tuple[str, ...]:
    """Names of what a posture does not explain, and of what is seen on limbs that it contorts."""
    points = shown.points_of(False)
    off = frame_residuals(shown.evidence, shown.regions, points, posture, shown.frame)
    names = [shown.tracks.names[marker] for marker in off.markers]
    # Hands and feet turn about wrists and ankles, of which a posture knows nothing.
    names += [name for name in off.points if USUAL_PLACES[name].error_std_m <= JOINT_ERROR_STD_M]
    bent = known.plausibility.contorted(known.pools.body.pose(Posture.stack([posture])))[0]
    parts = [part for part, is_bent in zip(PARTS, bent, strict=True) if is_bent]
    worn = zip(shown.tracks.names, shown.segments, shown.tracks.visible[0], strict=True)
    names += [name for name, segment, seen in worn if seen and limb_of(segment) in parts]
    if not shown.segments:
        seen = zip(shown.keypoints.names, shown.points.seen[0], strict=True)
        names += [name for name, is_seen in seen if is_seen and limb_of(name) in parts]
    return tuple(dict.fromkeys(names))
