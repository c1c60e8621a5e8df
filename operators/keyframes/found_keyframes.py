"""What a take's found keyframes were made of, and which of them are undecided."""

from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..shell.take_state import TakeState

if TYPE_CHECKING:
    from ...core.prior.keyframes import Matched


def known_matches(take: bpy.types.PropertyGroup) -> "dict[float, Matched]":
    """What the take's found keyframes were made of, by scene frame, those changed since left out."""
    return {round(match.frame, 3): match.matched for match in _untouched(take)}


def undecided_matches(take: bpy.types.PropertyGroup) -> "dict[float, Matched]":
    """The same without those whose candidate a person chose: what may be found anew, and removed."""
    return {round(match.frame, 3): match.matched for match in _untouched(take) if not match.by_hand}


def _untouched(take: bpy.types.PropertyGroup) -> list[bpy.types.PropertyGroup]:
    untouched = set(TakeState(take).matched)
    return [match for match in take.matching.matches if round(match.frame, 3) in untouched]


def chosen_match(take: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup:
    """The found keyframe that is chosen in the list: the current frame's, or else the last one chosen.

    Raises:
        InputError: There is none.
    """
    matching = take.matching
    if not 0 <= matching.shown_match < len(matching.matches):
        raise InputError("no found keyframe is chosen; pose all first, and choose a frame in the list")
    return matching.matches[matching.shown_match]
