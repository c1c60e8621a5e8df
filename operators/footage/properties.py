"""Height, tilt and roll of a take's camera as fields: they read and write the camera object."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import bpy
from bpy.types import Context, PropertyGroup, UILayout

from ...core.take.conversion_settings import MOST_PEOPLE
from ..bridge.footage import fixed_reason, read_placement, write_placement
from ..shell.base_operator import capitalized
from ..shell.fields import HIDDEN, Choice, Integer, Number, Switch, Text, Vector
from ..shell.take_state import TakeState
from ..shell.takes import NO_GUESS

DECIMALS = 5  # Digits that are shown: Blender's own matrices have about as many, and a level camera shows 0


def still_camera(_context: Context, state: TakeState | None) -> str | None:
    """The take's camera stands still, and can be set."""
    reason = fixed_reason(None if state is None else state.take.camera)
    return None if reason is None else capitalized(reason)


def confirm_placement(take: PropertyGroup) -> None:
    """Let the camera's placement count as known in every take with this camera."""
    for other in take.id_data.keymark.takes:
        if other.camera == take.camera:
            other.guessed_placement = NO_GUESS


def placement_accessors(field: str) -> dict[str, Callable[..., Any]]:
    """Getter and setter of a property for a field of the placement of a take's camera."""

    def get(take: PropertyGroup) -> float:
        return 0.0 if take.camera is None else round(getattr(read_placement(take.camera), field), DECIMALS)

    def change(take: PropertyGroup, value: float) -> None:
        """What was entered is no guess, whatever the number."""
        if fixed_reason(take.camera) is None:
            write_placement(take.camera, replace(read_placement(take.camera), **{field: value}))
            confirm_placement(take)
            take.camera_findings = ""

    return {"get": get, "set": change}


class KEYMARK_PG_clip_state(bpy.types.PropertyGroup):
    """State of a take's clip at the last check of its file."""

    missing: Switch("Missing", "The clip's file was not found", options=HIDDEN)
    contents: Text("Contents", "Digest of the clip's file", options=HIDDEN)
    rate: Number("Rate", "Frames per second of the clip on the timeline", min=0.0, options=HIDDEN)
    variable_rate: Switch("Variable Rate", "The clip's frames are unevenly spaced in time", options=HIDDEN)


class Part:
    """Mixin of properties that say which part of a clip is animated, and who performs."""

    is_part: Switch("Part of the Clip", "Animate some of the frames alone; the motion is empty in all others")
    first_frame: Integer("First Frame", "First scene frame of the part", default=1)
    last_frame: Integer("Last Frame", "Last scene frame of the part", default=100)
    performer: Integer(
        "Performer",
        "Who of several people performs, counted from the left where all are first seen; 0 for the one who "
        "is posed, or the largest who is there longest",
        min=0,
        max=MOST_PEOPLE,
    )

    @property
    def inputs(self) -> dict[str, Any]:
        """The same as fields of core's `Inputs`."""
        shot = (self.first_frame, self.last_frame) if self.is_part else None
        return {"shot": shot, "performer": self.performer or None}


def draw_part(layout: UILayout, part: Part) -> None:
    """Draw which part is animated, and who performs."""
    layout.prop(part, "performer")
    layout.prop(part, "is_part")
    frames = layout.column(align=True)
    frames.active = part.is_part
    frames.prop(part, "first_frame")
    frames.prop(part, "last_frame")


class KEYMARK_PG_part(Part, bpy.types.PropertyGroup):
    """Which part of a take's clip is animated, and who performs."""


KINDS = (
    ("VERTICAL", "Vertical", "Plumb in the world: door frames, corners of walls"),
    ("LEVEL", "Level", "Level and parallel to each other in the world: on the floor, or along a wall"),
    ("ACROSS", "Across", "Level, and at right angles to the lines that are called level"),
    ("HEIGHT", "Known Height", "From the floor up to a known height: the performer, or a door"),
)
"""Kinds of lines that are drawn over the footage."""


class KEYMARK_PG_camera_line(bpy.types.PropertyGroup):
    """A line that was drawn over the footage to find the camera."""

    kind: Choice("Kind", "What the line is in the world", items=KINDS)
    start: Vector("Start", "In pixels of the footage from its top left corner", size=2)
    end: Vector("End", "In pixels of the footage from its top left corner", size=2)
    length: Number(
        "Length",
        "Length of a line of known height; 0 for the performer's height",
        subtype="DISTANCE",
        min=0.0,
        soft_max=10.0,
    )
    frame: Integer("Frame", "Scene frame in which it was drawn")
