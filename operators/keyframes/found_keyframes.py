"""What a take's found keyframes were made of, and the way from one frame to another."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from bpy.types import PropertyGroup

from ..shell.fields import Choice
from ..shell.take_state import TakeState

if TYPE_CHECKING:
    from ...core.prior.keyframes import Matched


def known_matches(take: PropertyGroup, by_hand: bool = True) -> "dict[float, Matched]":
    """What the take's found keyframes were made of, by scene frame, those changed since left out.

    Those whose candidate a person chose only where `by_hand`: the others may be found anew, and removed.
    """
    untouched = set(TakeState(take).matched)
    matches = [match for match in take.matching.matches if by_hand or not match.by_hand]
    return {frame: match.matched for match in matches if (frame := round(match.frame, 3)) in untouched}


def match_here(take: PropertyGroup) -> Any:
    """The found keyframe of the current frame, or None."""
    index = TakeState(take).match_at(take.id_data.frame_current_final)
    return take.matching.matches[index] if index >= 0 else None


def directions(what: str, description: str) -> Any:
    """The property of an operator that goes to the next or the previous of some frames."""
    items = [(each.upper(), each.title(), f"Go to the {each} {what}") for each in ("next", "previous")]
    return Choice("Direction", description, items=items)


def neighbor(frames: Sequence[float], now: float, direction: str, apart: float = 1e-3) -> float | None:
    """Of ascending frames the next or the previous one, farther than `apart`; None beyond the last."""
    if direction == "NEXT":
        return next((frame for frame in frames if frame > now + apart), None)
    return next((frame for frame in reversed(frames) if frame < now - apart), None)
