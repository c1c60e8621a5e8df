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


def match_here(take: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup:
    """The found keyframe of the current frame.

    Raises:
        InputError: There is none.
    """
    frame = take.id_data.frame_current_final
    index = TakeState(take).match_at(frame)
    if index < 0:
        raise InputError(f"frame {frame:g} holds no found keyframe; choose one in the list")
    return take.matching.matches[index]
