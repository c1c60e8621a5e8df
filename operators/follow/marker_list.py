"""Operators of the lists of markers and of regions that are never one, and the switch of their masks."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator, Unchanged, remove_active
from ..shell.requirements import footage, idle, markers, picked_color
from ..shell.takes import active_take, ensure_take, find_take, redraw_footage
from .marker_properties import SEGMENTS, clear_readouts
from .marker_styles import USUAL_SEGMENTS, append_marker, append_usual_markers
from .mask_previews import preview_of, update_masks


class KEYMARK_OT_add_marker(BaseOperator, bpy.types.Operator):
    """Add a marker on the next body part that usually wears one"""

    bl_label = "Add Marker"

    def run(self, context: bpy.types.Context) -> None:
        take = ensure_take(context.scene)
        marked = {marker.segment for marker in take.markers}
        free = [segment for segment in (*USUAL_SEGMENTS, *SEGMENTS) if segment not in marked]
        if not free:
            raise InputError("every body part has a marker already")
        append_marker(take, free[0])


class KEYMARK_OT_add_usual_markers(BaseOperator, bpy.types.Operator):
    """Add the five markers that help most: trunk, both forearms and both shins"""

    bl_label = "Add Usual Five"

    def run(self, context: bpy.types.Context) -> None:
        take = ensure_take(context.scene)
        if {marker.segment for marker in take.markers}.issuperset(USUAL_SEGMENTS):
            raise Unchanged("trunk, forearms and shins have markers already")
        append_usual_markers(take)


class KEYMARK_OT_remove_marker(BaseOperator, bpy.types.Operator):
    """Remove the active marker"""

    bl_label = "Remove Marker"
    requirements = (markers,)

    def run(self, context: bpy.types.Context) -> None:
        take = active_take(context.scene)
        if take.markers[min(take.active_marker, len(take.markers) - 1)].is_picked:
            clear_readouts(take)
        remove_active(take, "markers", "active_marker")


def some_ignored(context: bpy.types.Context) -> str | None:
    """Some region of the picture is ignored."""
    take = find_take(context.scene)
    return None if take and len(take.ignored_regions) else "No region of the picture is left out"


class KEYMARK_OT_remove_ignored_region(BaseOperator, bpy.types.Operator):
    """Search the chosen region of the picture for markers again"""

    bl_label = "Remove Region"
    requirements = (some_ignored, idle)

    def run(self, context: bpy.types.Context) -> None:
        take = active_take(context.scene)
        remove_active(take, "ignored_regions", "active_ignored")
        clear_readouts(take)
        redraw_footage(context)


class KEYMARK_OT_show_masks(BaseOperator, bpy.types.Operator):
    """Highlight the markers' colors over the footage, in the camera view and the Movie Clip editor"""

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
