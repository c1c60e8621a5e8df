"""Found keyframes of a take, those that nobody posed: what became of each, and which of them are in doubt."""

from collections.abc import Sequence

import bpy

from .contradictions import contradictions_at
from .keyed_frames import SAME_FRAME, matched_frames, posed_frames

DOUBTFUL = 0.5
"""Confidence below which a found keyframe is doubtful: it is more likely wrong than right."""


def state_of(take: bpy.types.PropertyGroup, match: bpy.types.PropertyGroup) -> str:
    """What has become of a found keyframe: FOUND still, POSED by the animator, or GONE with its keys."""
    frame = round(match.frame, 3)
    if frame in matched_frames(take):
        return "FOUND"
    return "POSED" if frame in posed_frames(take) else "GONE"


def is_doubtful(take: bpy.types.PropertyGroup, match: bpy.types.PropertyGroup) -> bool:
    """Whether a found keyframe is worth a check: undecided yet, and unsure or contradicted."""
    if match.by_hand or state_of(take, match) != "FOUND":
        return False
    return bool(match.confidence < DOUBTFUL or contradictions_at(take, match.frame))


def doubtful_matches(take: bpy.types.PropertyGroup) -> list[int]:
    """Places in the list of the doubtful found keyframes: contradicted ones first, then the least sure."""
    matches: Sequence[bpy.types.PropertyGroup] = take.matching.matches
    doubtful = [index for index, match in enumerate(matches) if is_doubtful(take, match)]

    def rank(index: int) -> tuple[bool, float, int]:
        match = matches[index]
        return not contradictions_at(take, match.frame), match.confidence, index

    return sorted(doubtful, key=rank)


def match_at(take: bpy.types.PropertyGroup, frame: float) -> int:
    """Place in the list of the found keyframe at a scene frame; -1 for none."""
    apart = [abs(match.frame - frame) for match in take.matching.matches]
    nearest = min(range(len(apart)), key=apart.__getitem__, default=-1)
    return nearest if apart and apart[nearest] < SAME_FRAME else -1


def offered_at(take: bpy.types.PropertyGroup, frame: float) -> bpy.types.PropertyGroup | None:
    """The poses to choose from at a scene frame that has no key; None where there are none."""
    offered = take.offered
    here = len(offered.candidates) > 1 and abs(offered.frame - frame) < SAME_FRAME
    keyed = round(frame, 3) in {*matched_frames(take), *posed_frames(take)}
    return offered if here and not keyed else None


def count_found(take: bpy.types.PropertyGroup) -> tuple[int, int]:
    """Number of the found keyframes that are still as they were found, and of the doubtful ones."""
    matches = take.matching.matches
    return sum(state_of(take, match) == "FOUND" for match in matches), len(doubtful_matches(take))
