"""New markers of a take: the segment the next one goes on, and its name."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.requirements import footage, idle, markers, picked_color
from ..shell.takes import active_take, ensure_take, redraw_footage, unique_name
from .marker_properties import SEGMENTS, clear_readouts
from .mask_previews import preview_of, update_masks

USUAL_SEGMENTS = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
"""The five segments whose markers help most, in the order in which they are offered."""


def next_segment(take: bpy.types.PropertyGroup) -> str | None:
    """Return the segment to mark next; None if all have markers."""
    marked = {marker.segment for marker in take.markers}
    return next((segment for segment in (*USUAL_SEGMENTS, *SEGMENTS) if segment not in marked), None)


def append_marker(take: bpy.types.PropertyGroup, segment: str) -> bpy.types.PropertyGroup:
    """Add a marker with a unique name after its segment, and make it the active one."""
    name = unique_name(segment, (marker.name for marker in take.markers))
    marker = take.markers.add()
    marker.segment, marker.name = segment, name
    marker.named_after = segment
    take.active_marker = len(take.markers) - 1
    return marker


def append_usual_markers(take: bpy.types.PropertyGroup) -> None:
    """Add those of the usual five that are missing; the first of them becomes the active one."""
    marked, first = {marker.segment for marker in take.markers}, len(take.markers)
    for segment in USUAL_SEGMENTS:
        if segment not in marked:
            append_marker(take, segment)
    take.active_marker = first


class KEYMARK_OT_remove_marker(BaseOperator, bpy.types.Operator):
    """Remove the active marker"""

    bl_label = "Remove Marker"
    requirements = (markers,)

    def run(self, context: bpy.types.Context) -> None:
        take = active_take(context.scene)
        index = min(take.active_marker, len(take.markers) - 1)
        if take.markers[index].is_picked:
            clear_readouts(take)
        take.markers.remove(index)
        take.active_marker = max(0, index - 1)


class KEYMARK_OT_show_masks(BaseOperator, bpy.types.Operator):
    """Highlight the markers' colors over the footage, in the camera view and the Movie Clip editor"""

    bl_idname = "keymark.show_masks"
    bl_label = "Show Masks"
    bl_options = {"REGISTER"}
    requirements = (footage, markers, picked_color, idle)

    def run(self, context: bpy.types.Context) -> None:
        manager = context.window_manager
        if not manager.keymark_show_masks:
            if preview_of(active_take(context.scene)) is None:
                _check_markers()
            update_masks(context.scene)
        manager.keymark_show_masks = not manager.keymark_show_masks
        redraw_footage(context)


def _check_markers() -> None:
    """Run the check of the markers, on a timer in the user interface."""
    try:
        bpy.ops.keymark.check_markers("INVOKE_DEFAULT")
    except RuntimeError as error:
        raise InputError(str(error).removeprefix("Error: ").strip()) from error


class KEYMARK_OT_add_marker(BaseOperator, bpy.types.Operator):
    """Add a marker on the next body part that usually wears one"""

    bl_idname = "keymark.add_marker"
    bl_label = "Add Marker"
    bl_options = {"REGISTER", "UNDO"}

    def run(self, context: bpy.types.Context) -> set[str] | None:
        take = ensure_take(context.scene)
        segment = next_segment(take)
        if segment is None:
            self.report({"ERROR"}, "Every body part has a marker already")
            return {"CANCELLED"}
        append_marker(take, segment)
        return None


class KEYMARK_OT_add_usual_markers(BaseOperator, bpy.types.Operator):
    """Add the five markers that help most: trunk, both forearms and both shins"""

    bl_idname = "keymark.add_usual_markers"
    bl_label = "Add Usual Five"
    bl_options = {"REGISTER", "UNDO"}

    def run(self, context: bpy.types.Context) -> set[str] | None:
        take = ensure_take(context.scene)
        if {marker.segment for marker in take.markers}.issuperset(USUAL_SEGMENTS):
            self.report({"INFO"}, "Trunk, forearms and shins have markers already")
            return {"CANCELLED"}
        append_usual_markers(take)
        return None
