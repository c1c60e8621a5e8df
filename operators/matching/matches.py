"""Matches of a take, the keyframes that a library gave: which is chosen, and what has become of each."""

from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..shell.keyed_frames import invalidate_keyed_frames, matched_frames, posed_frames

if TYPE_CHECKING:
    from ...core.prior.keyframes import Matched


def known_matches(take: bpy.types.PropertyGroup) -> "dict[float, Matched]":
    """What the take's matched keyframes were matched with, by scene frame, those changed since left out."""
    invalidate_keyed_frames()  # a script may have changed a key that Blender has not told of yet
    untouched = set(matched_frames(take))
    matches = take.matching.matches
    return {round(match.frame, 3): match.matched for match in matches if round(match.frame, 3) in untouched}


def chosen_match(take: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup:
    """The match that is chosen in the list.

    Raises:
        InputError: There is none.
    """
    matching = take.matching
    if not 0 <= matching.active_match < len(matching.matches):
        raise InputError("no match is chosen; match a library first, and choose a frame in the list")
    return matching.matches[matching.active_match]


def state_of(take: bpy.types.PropertyGroup, match: bpy.types.PropertyGroup) -> str:
    """What has become of a match: MATCHED still, POSED by the animator, or GONE with its keys."""
    frame = round(match.frame, 3)
    if frame in matched_frames(take):
        return "MATCHED"
    return "POSED" if frame in posed_frames(take) else "GONE"
