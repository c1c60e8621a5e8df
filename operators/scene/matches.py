"""A take's matches: what is known of the keyframes that a library gave, kept with the take."""

from collections.abc import Collection
from typing import TYPE_CHECKING

import bpy

from .posed_frames import forget, matched_frames

if TYPE_CHECKING:
    from ...core.body.posture import Posture
    from ...core.prior.keyframes import Matched


def known_matches(take: bpy.types.PropertyGroup) -> "dict[float, Matched]":
    """What the take's keyframes were matched with that nobody has touched since, by scene frame."""
    forget()  # a script may have changed a key that Blender has not told of yet
    untouched = set(matched_frames(take))
    matches = take.matching.matches
    return {round(match.frame, 3): match.matched for match in matches if round(match.frame, 3) in untouched}


def match_at(take: bpy.types.PropertyGroup, frame: float) -> bpy.types.PropertyGroup | None:
    """The match of a scene frame, whether or not its keyframe was changed since."""
    return next((match for match in take.matching.matches if abs(match.frame - frame) < 1e-3), None)


def add_match(take: bpy.types.PropertyGroup, frame: float, library: str) -> bpy.types.PropertyGroup:
    """Add a match without candidates."""
    match = take.matching.matches.add()
    match.frame, match.library = frame, library
    return match


def add_candidate(
    match: bpy.types.PropertyGroup, posture: "Posture", name: str, mirrored: bool, confidence: float
) -> None:
    """Add what a match's frame may show; the first one added is the one it has."""
    candidate = match.candidates.add()
    candidate.name, candidate.mirrored, candidate.confidence = name, mirrored, confidence
    candidate.take_posture(posture)


def clear_choice(matching: bpy.types.PropertyGroup) -> None:
    """Forget what was found; what is to be looked for stays."""
    for name in ("ranking", "matches"):
        getattr(matching, name).clear()
    for name in ("reason", "fit", "active_match"):
        matching.property_unset(name)


def drop_matches(take: bpy.types.PropertyGroup, frames: Collection[float]) -> None:
    """Forget the matches of some scene frames."""
    matches = take.matching.matches
    for place in reversed(range(len(matches))):
        if round(matches[place].frame, 3) in frames:
            matches.remove(place)
