"""What the footage was matched with: which library, how sure that is, and each frame's posture."""

from typing import TYPE_CHECKING

import bpy

from ...core.body.human import HUMAN
from ...core.library.texts import EVERY_LIBRARY
from ..library.registry import library_items

if TYPE_CHECKING:
    from ...core.prior.keyframes import Matched

PLACE_VALUES = 6
"""Degrees of freedom that say where the hips are and how they are turned; Blender's vectors are short."""
DOUBTFUL = 0.5
"""A match less sure than this is worth a look."""
SURE = 0.8
FLOORS = (
    ("AUTO", "Find from Footage", "How high the floor is follows from the performer's size in the footage"),
    ("HEIGHT", "Known Height", "The floor that the performer stands on is this high in the scene"),
)


Entry = tuple[str, str, str, str, int]
_entries: list[Entry] = []
"""What the menu of libraries shows; Blender needs the words as long as it shows them."""


def _libraries(matching: bpy.types.PropertyGroup, context: bpy.types.Context | None) -> list[Entry]:
    """The choice by itself, all libraries on the shelf, and the chosen one though it be gone from there."""
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
    """Clicking a match in the list goes there."""
    if matching.active_match < len(matching.matches):
        matching.matches[matching.active_match].go_to(matching.id_data)


class KEYMARK_PG_candidate(bpy.types.PropertyGroup):
    """A posture that a frame may show, placed in front of the camera."""

    name: bpy.props.StringProperty(name="Posture", description="The posture's name in its library")
    mirrored: bpy.props.BoolProperty(
        name="Mirrored", description="The posture is taken with left and right exchanged"
    )
    confidence: bpy.props.FloatProperty(
        name="Confidence",
        description="How probably this posture is about right",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
    )
    place: bpy.props.FloatVectorProperty(
        name="Place", description="Where the hips are and how they are turned", size=PLACE_VALUES
    )
    turned: bpy.props.FloatProperty(
        name="Turned",
        description="How far the performer faces to their left of what matching chose, seen from above",
        subtype="ANGLE",
    )
    turns: bpy.props.FloatVectorProperty(
        name="Turns", description="How the joints are turned", size=HUMAN.dof_count - PLACE_VALUES
    )


class KEYMARK_PG_match(bpy.types.PropertyGroup):
    """A frame whose posture a library gave."""

    frame: bpy.props.FloatProperty(name="Frame", description="The scene frame")
    library: bpy.props.StringProperty(
        name="Library", description="What the library is known by that the posture is from"
    )
    candidates: bpy.props.CollectionProperty(type=KEYMARK_PG_candidate)
    chosen: bpy.props.IntProperty(
        name="Chosen", description="Which of the candidates the frame has", default=0, min=0
    )
    by_hand: bpy.props.BoolProperty(
        name="Chosen by Hand", description="A person has chosen among the candidates, so nothing is in doubt"
    )

    @property
    def candidate(self) -> bpy.types.PropertyGroup:
        """The candidate that the frame has."""
        return self.candidates[min(self.chosen, len(self.candidates) - 1)]

    @property
    def confidence(self) -> float:
        """How probably the posture is about right; a person's choice counts as the best of them."""
        if self.by_hand:
            return float(max(candidate.confidence for candidate in self.candidates))
        return float(self.candidate.confidence)

    @property
    def is_doubtful(self) -> bool:
        """Whether it is worth a look."""
        return not self.by_hand and self.confidence < DOUBTFUL

    @property
    def matched(self) -> "Matched":
        """What the estimate is told of it."""
        from ...core.prior.keyframes import Matched

        chosen = self.candidate
        return Matched(self.library, chosen.name, chosen.mirrored, min(max(self.confidence, 0.0), 1.0))

    def go_to(self, scene: bpy.types.Scene) -> None:
        """Let the scene show this frame."""
        whole = int(self.frame // 1.0)
        scene.frame_set(whole, subframe=self.frame - whole)


class KEYMARK_PG_library_chance(bpy.types.PropertyGroup):
    """How probably the footage shows what a library holds."""

    name: bpy.props.StringProperty(name="Library", description="The library's title")
    probability: bpy.props.FloatProperty(
        name="Probability",
        description="How probably the footage shows this kind of motion, of all that were tried",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
    )


class KEYMARK_PG_matching(bpy.types.PropertyGroup):
    """What a take's footage is matched with, and what was found."""

    library_name: bpy.props.StringProperty(
        name="Library",
        description="What the library is known by that is looked for; menus number theirs, which may change",
        default=EVERY_LIBRARY,
        options={"HIDDEN"},
    )
    library: bpy.props.EnumProperty(
        name="Library",
        description="What the footage is matched with",
        items=_libraries,
        get=_library_number,
        set=_set_library,
    )
    floor: bpy.props.EnumProperty(
        name="Floor", description="What is known of the floor, which settles the distance", items=FLOORS
    )
    floor_height: bpy.props.FloatProperty(
        name="Floor Height",
        description="How high the floor lies that the performer stands on",
        subtype="DISTANCE",
        precision=3,
        default=0.0,
        soft_min=-5.0,
        soft_max=5.0,
    )
    ranking: bpy.props.CollectionProperty(type=KEYMARK_PG_library_chance)
    reason: bpy.props.StringProperty(
        name="Reason", description="Why this library, or why none, as the last matching said"
    )
    fit: bpy.props.FloatProperty(
        name="Fit",
        description="How well the matched postures explain the footage; negative before the first time",
        default=-1.0,
        min=-1.0,
        max=1.0,
    )
    floor_found: bpy.props.FloatProperty(
        name="Floor Found",
        description="How high the floor lies that the performer was placed on by the last matching",
        subtype="DISTANCE",
        precision=3,
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
    (KEYMARK_PG_candidate, KEYMARK_PG_match, KEYMARK_PG_library_chance, KEYMARK_PG_matching)
)
