"""Properties of matching: settings, and matches with their candidates."""

from typing import TYPE_CHECKING

import bpy

from ...core.body.human import HUMAN
from ...core.library.texts import EVERY_LIBRARY
from ..library.registry import library_items

if TYPE_CHECKING:
    from ...core.prior.keyframes import Matched

PLACE_VALUES = 6
"""Degrees of freedom of the hips' pose, stored apart because Blender's vectors are short."""
DOUBTFUL = 0.5
"""Confidence below which a match is doubtful."""
SURE = 0.8
FLOORS = (
    ("AUTO", "Find from Footage", "How high the floor is follows from the performer's size in the footage"),
    ("HEIGHT", "Known Height", "The floor that the performer stands on is this high in the scene"),
)


Entry = tuple[str, str, str, str, int]
_entries: list[Entry] = []
"""Items of the menu of libraries: Blender keeps no copy of the strings."""


def _libraries(matching: bpy.types.PropertyGroup, context: bpy.types.Context | None) -> list[Entry]:
    """The automatic choice, all registered libraries, and the chosen one even if it is missing."""
    rows = [item[:4] for item in library_items(matching, context)]
    name = matching.library_name
    if all(name != row[0] for row in rows):
        rows.append((name, name, "This library is not there any more; import it again", "ERROR"))
    _entries[:] = [(*row, number) for number, row in enumerate(rows)]
    return _entries


def _library_number(matching: bpy.types.PropertyGroup) -> int:
    names = [entry[0] for entry in _libraries(matching, None)]
    return names.index(matching.library_name)


def _set_library(matching: bpy.types.PropertyGroup, number: int) -> None:
    matching.library_name = _libraries(matching, None)[number][0]


def _chosen(matching: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Go to the frame of the match that was clicked in the list."""
    if matching.active_match < len(matching.matches):
        matching.matches[matching.active_match].go_to(matching.id_data)


class KEYMARK_PG_candidate(bpy.types.PropertyGroup):
    """A posture that a frame may show, placed in the world."""

    name: bpy.props.StringProperty(name="Posture", description="The posture's name in its library")
    mirrored: bpy.props.BoolProperty(
        name="Mirrored", description="Whether left and right of the posture are exchanged"
    )
    confidence: bpy.props.FloatProperty(
        name="Confidence",
        description="Probability that this posture is about right",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
    )
    place: bpy.props.FloatVectorProperty(
        name="Place", description="Location and rotation of the hips", size=PLACE_VALUES
    )
    turned: bpy.props.FloatProperty(
        name="Turned",
        description="Turn to the performer's left from the posture that matching chose, seen from above",
        subtype="ANGLE",
    )
    turns: bpy.props.FloatVectorProperty(
        name="Turns", description="Rotations of the joints", size=HUMAN.dof_count - PLACE_VALUES
    )


class KEYMARK_PG_match(bpy.types.PropertyGroup):
    """A matched frame with its candidates."""

    frame: bpy.props.FloatProperty(name="Frame", description="The scene frame")
    library: bpy.props.StringProperty(name="Library", description="Identifier of the posture's library")
    candidates: bpy.props.CollectionProperty(type=KEYMARK_PG_candidate)
    chosen: bpy.props.IntProperty(
        name="Chosen", description="Index of the candidate that the frame has", default=0, min=0
    )
    by_hand: bpy.props.BoolProperty(
        name="Chosen by Hand", description="Whether a person chose the candidate, so that it is not doubtful"
    )

    @property
    def candidate(self) -> bpy.types.PropertyGroup:
        """The candidate that the frame has."""
        return self.candidates[min(self.chosen, len(self.candidates) - 1)]

    @property
    def confidence(self) -> float:
        """Probability that the posture is about right; a person's choice counts as the best candidate."""
        if self.by_hand:
            return float(max(candidate.confidence for candidate in self.candidates))
        return float(self.candidate.confidence)

    @property
    def is_doubtful(self) -> bool:
        """Whether the match is worth a check."""
        return not self.by_hand and self.confidence < DOUBTFUL

    @property
    def matched(self) -> "Matched":
        """The match as core's `Matched`."""
        from ...core.prior.keyframes import Matched

        chosen = self.candidate
        return Matched(self.library, chosen.name, chosen.mirrored, min(max(self.confidence, 0.0), 1.0))

    def go_to(self, scene: bpy.types.Scene) -> None:
        """Go to this frame in the scene."""
        whole = int(self.frame // 1.0)
        scene.frame_set(whole, subframe=self.frame - whole)


class KEYMARK_PG_matching(bpy.types.PropertyGroup):
    """Settings and results of matching a take."""

    library_name: bpy.props.StringProperty(
        name="Library",
        description="Identifier of the library to match with; the numbers of menu items may change",
        default=EVERY_LIBRARY,
        options={"HIDDEN"},
    )
    library: bpy.props.EnumProperty(
        name="Library",
        description="Library that the footage is matched with",
        items=_libraries,
        get=_library_number,
        set=_set_library,
    )
    floor: bpy.props.EnumProperty(
        name="Floor",
        description="Source of the floor's height, which determines the performer's distance",
        items=FLOORS,
    )
    floor_height: bpy.props.FloatProperty(
        name="Floor Height",
        description="Height of the floor that the performer stands on",
        subtype="DISTANCE",
        precision=4,
        default=0.0,
        soft_min=-5.0,
        soft_max=5.0,
    )
    reason: bpy.props.StringProperty(name="Reason", description="How sure the last matching is")
    fit: bpy.props.FloatProperty(
        name="Fit",
        description="Share of the footage that the matches explain; negative before the first matching",
        default=-1.0,
        min=-1.0,
        max=1.0,
    )
    floor_found: bpy.props.FloatProperty(
        name="Floor Found",
        description="Height of the floor in the last matching",
        subtype="DISTANCE",
        precision=4,
    )
    matches: bpy.props.CollectionProperty(type=KEYMARK_PG_match)
    active_match: bpy.props.IntProperty(
        name="Match",
        description="The match chosen in the list; choosing one goes there",
        default=0,
        min=0,
        update=_chosen,
    )


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_PG_candidate, KEYMARK_PG_match, KEYMARK_PG_matching)
)
