"""Poses offered for a frame that is not keyed: what fitting it has found, the shown one first."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import bpy

if TYPE_CHECKING:
    from ...core.posing.candidates import Candidate


def offer_poses(take: bpy.types.PropertyGroup, frame: float, candidates: Sequence["Candidate"]) -> None:
    """Offer candidates at a scene frame, the one that the actor shows first, in place of all others."""
    from ...core.library.several_libraries import COMPOSED
    from ..matching.match_edits import add_candidate

    offered = take.offered
    offered.candidates.clear()
    offered.frame, offered.library, offered.chosen = frame, COMPOSED, 0
    for each in candidates if len(candidates) > 1 else ():
        add_candidate(offered, each.posture, each.name, each.mirrored, each.confidence)
