"""Add colored markers."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.messages import say
from ..shell.takes import ensure_take
from .properties import SEGMENTS

USUAL_SEGMENTS = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
"""The five that serve best, in the order in which they are offered."""


class KEYMARK_OT_add_marker(BaseOperator, bpy.types.Operator):
    """Add a marker on the next body part that usually wears one"""

    bl_idname = "keymark.add_marker"
    bl_label = "Add Marker"
    bl_options = {"REGISTER", "UNDO"}

    def run(self, context: bpy.types.Context) -> None:
        """Add it and make it the active one."""
        take = ensure_take(context.scene)
        segment = next_segment(take)
        if segment is None:
            say(self, "ERROR", "Every body part has a marker already")
            return {"CANCELLED"}
        append_marker(take, segment)


class KEYMARK_OT_add_usual_markers(BaseOperator, bpy.types.Operator):
    """Add the five markers that serve best: trunk, both forearms and both shins"""

    bl_idname = "keymark.add_usual_markers"
    bl_label = "Add Usual Five"
    bl_options = {"REGISTER", "UNDO"}

    def run(self, context: bpy.types.Context) -> None:
        """Add those that are missing; the first of them becomes the active one."""
        take = ensure_take(context.scene)
        taken = {marker.segment for marker in take.markers}
        missing = [segment for segment in USUAL_SEGMENTS if segment not in taken]
        if not missing:
            say(self, "INFO", "Trunk, forearms and shins have markers already")
            return {"CANCELLED"}
        first = len(take.markers)
        for segment in missing:
            append_marker(take, segment)
        take.active_marker = first
        return {"FINISHED"}


def next_segment(take: bpy.types.PropertyGroup) -> str | None:
    """The body part to mark next; None where all are."""
    taken = {marker.segment for marker in take.markers}
    return next((segment for segment in (*USUAL_SEGMENTS, *SEGMENTS) if segment not in taken), None)


def free_name(take: bpy.types.PropertyGroup, segment: str) -> str:
    """A name for a marker on a segment: the segment's own where no other marker is called so."""
    names = {marker.name for marker in take.markers}
    numbered = (f"{segment}.{number:03d}" for number in range(1, len(names) + 1))
    return segment if segment not in names else next(name for name in numbered if name not in names)


def append_marker(take: bpy.types.PropertyGroup, segment: str) -> bpy.types.PropertyGroup:
    """Add a marker that is named after its segment, and make it the active one."""
    name = free_name(take, segment)
    marker = take.markers.add()
    marker.segment, marker.name = segment, name
    marker.named_after = segment
    take.active_marker = len(take.markers) - 1
    return marker


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_OT_add_marker, KEYMARK_OT_add_usual_markers)
)
