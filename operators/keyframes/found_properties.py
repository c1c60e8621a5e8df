"""Properties of finding keyframes: settings, and found keyframes with their candidates."""

from collections.abc import Sequence
from typing import Any

import bpy
from bpy.types import Context, PropertyGroup

from ...core.body.human import HUMAN
from ...core.prior.keyframes import Matched
from ...core.prior.texts import EVERY_LIBRARY
from ..bridge.scene_frames import show_frame
from ..library.registry import library_items
from ..shell.fields import HIDDEN, Choice, Entries, Integer, Number, Switch, Text, Vector
from ..shell.take_state import TakeState

PLACE_VALUES = 6  # Degrees of freedom of the hips' pose, stored apart because Blender's vectors are short
FLOORS = (
    ("AUTO", "Find from Footage", "How high the floor is follows from the performer's size in the footage"),
    ("HEIGHT", "Known Height", "The floor that the performer stands on is this high in the scene"),
)


Entry = tuple[str, str, str, str, int]
_entries: list[Entry] = []  # Items of the menu of libraries: Blender keeps no copy of the strings


def _libraries(matching: PropertyGroup, context: Context | None) -> list[Entry]:
    every = (EVERY_LIBRARY, "All Libraries", "Each limb may come from another library", "ASSET_MANAGER")
    rows = [every, *(item[:4] for item in library_items(matching, context))]
    name = matching.library_name
    if name and all(name != row[0] for row in rows):
        rows.append((name, name, "This library is not there any more; import it again", "ERROR"))
    _entries[:] = [(*row, number) for number, row in enumerate(rows)]
    return _entries


def _shown_match(matching: PropertyGroup) -> int:
    """The found keyframe of the current frame; elsewhere the one that was chosen last."""
    scene = matching.id_data
    take = next((take for take in scene.keymark.takes if take.matching == matching), None)
    here = -1 if take is None else TakeState(take).match_at(scene.frame_current_final)
    return here if here >= 0 else min(matching.active_match, max(len(matching.matches) - 1, 0))


def _choose_match(matching: PropertyGroup, index: int) -> None:
    matching.active_match = index
    if index < len(matching.matches):
        show_frame(matching.id_data, matching.matches[index].frame)


class KEYMARK_PG_candidate(bpy.types.PropertyGroup):
    """A posture that a frame may show, placed in the world."""

    name: Text("Posture", "The posture's name in its library")
    mirrored: Switch("Mirrored", "Whether left and right of the posture are exchanged")
    confidence: Number("Confidence", "Chance that this posture is right", subtype="FACTOR", min=0.0, max=1.0)
    place: Vector("Place", "Location and rotation of the hips", size=PLACE_VALUES)
    turned: Number(
        "Turned",
        "Turn to the performer's left from the posture that was chosen first, seen from above",
        subtype="ANGLE",
    )
    limbs: Text(
        "Limbs",
        "Limbs that are elsewhere than the first candidate's, which shows what is chosen between",
        options=HIDDEN,
    )
    turns: Vector("Turns", "Rotations of the joints", size=HUMAN.dof_count - PLACE_VALUES)


class KEYMARK_PG_match(bpy.types.PropertyGroup):
    """A found keyframe with its candidates."""

    frame: Number("Frame", "The scene frame")
    library: Text("Library", "Identifier of the posture's library; composed of several")
    candidates: Entries(type=KEYMARK_PG_candidate)
    chosen: Integer("Chosen", "Index of the candidate that the frame has", default=0, min=0)
    by_hand: Switch("Chosen by Hand", "Whether a person chose the candidate, so that it is not doubtful")

    @property
    def candidate(self) -> PropertyGroup:
        return self.candidates[min(self.chosen, len(self.candidates) - 1)]

    @property
    def confidence(self) -> float:
        """Probability that the posture is about right; a person's choice counts as the best candidate."""
        if self.by_hand:
            return float(max(candidate.confidence for candidate in self.candidates))
        return float(self.candidate.confidence)

    @property
    def matched(self) -> Matched:
        chosen = self.candidate
        return Matched(self.library, chosen.name, chosen.mirrored, min(max(self.confidence, 0.0), 1.0))


class FloorSettings:
    """Mixin of properties: the floor that performers stand on while they are sought."""

    floor: Choice("Floor", "Source of the floor's height, which tells the performer's distance", items=FLOORS)
    floor_height: Number(
        "Floor Height",
        "Height of the floor that the performer stands on",
        subtype="DISTANCE",
        precision=4,
        default=0.0,
        soft_min=-5.0,
        soft_max=5.0,
    )


class KEYMARK_PG_matching(FloorSettings, bpy.types.PropertyGroup):
    """Settings and results of finding a take's keyframes."""

    library_name: Text(
        "Library",
        "Identifier of the only library to use; the numbers of menu items may change",
        options=HIDDEN,
    )
    library: Choice(
        "Library",
        "What is known of postures while keyframes are sought: all libraries, or one with "
        "the performer's own motion",
        items=_libraries,
        get=lambda matching: next(
            (entry[-1] for entry in _libraries(matching, None) if entry[0] == matching.library_name), 0
        ),
        set=lambda matching, index: setattr(matching, "library_name", _libraries(matching, None)[index][0]),
    )
    reason: Text("Reason", "Whether what was found last is usable, and what speaks for or against it")
    fit: Number(
        "Fit",
        "Probability that the found poses are usable; negative before any were found",
        default=-1.0,
        min=-1.0,
        max=1.0,
    )
    floor_found: Number(
        "Floor Found", "Height of the floor that the found poses stand on", subtype="DISTANCE", precision=4
    )
    corrected_frame: Number(
        "Corrected Frame",
        "The frame without a key whose pose was corrected last",
        default=-1e6,
        options=HIDDEN,
    )
    corrected_in_depth: Switch(
        "Corrected in Depth",
        "Whether that pose was moved in depth, and not in the camera's picture alone",
        options=HIDDEN,
    )

    @property
    def known_floor_m(self) -> float | None:
        """Height of the floor where it is given or was found [m]."""
        if self.floor == "HEIGHT":
            return float(self.floor_height)
        return float(self.floor_found) if self.is_property_set("floor_found") else None

    matches: Entries(type=KEYMARK_PG_match)
    active_match: Integer("Last Chosen", "The found keyframe that was chosen last", min=0, options=HIDDEN)
    shown_match: Integer(
        "Found Keyframe",
        "The found keyframe of the current frame; choosing one goes there",
        min=0,
        get=_shown_match,
        set=_choose_match,
    )


def known_matches(take: PropertyGroup, by_hand: bool = True) -> dict[float, Matched]:
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
