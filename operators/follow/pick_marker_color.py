"""Pick a marker's color from the footage, and check at once how well the marker is found."""

from typing import TYPE_CHECKING

import bpy

from ..shell.base_operator import reported, warn
from ..shell.footage_clicks import NAVIGATION, footage_is_shown
from ..shell.footage_view import ask, follow_mouse, pixel_under, stop_asking
from ..shell.job_operator import JobOperator, cancel_click
from ..shell.requirements import footage, idle, markers, picked_color
from ..shell.takes import active_take, footage_of, take_by_identifier
from .marker_styles import MarkerSearch, request_for, search_markers, write_search
from .mask_previews import show_masks

if TYPE_CHECKING:
    from ...core.progress import Job


class KEYMARK_OT_pick_marker_color(JobOperator, bpy.types.Operator):
    """Click on this one marker in the footage, to take its color from there and look for it in the clip"""

    bl_idname = "keymark.pick_marker_color"
    bl_label = "Pick Marker Color"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, markers, idle)

    pixel: bpy.props.FloatVectorProperty(
        name="Pixel",
        description="Where to pick, in pixels of the footage from its top left corner",
        size=2,
        options={"SKIP_SAVE"},
    )
    row: bpy.props.IntProperty(
        name="Row",
        description="Row of the marker in the list, from 0; -1 for the active one",
        default=-1,
        options={"SKIP_SAVE"},
    )

    _masks_before: bool | None = None
    """Whether masks were shown before the eyedropper; None in a script, which shows none."""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        take = active_take(context.scene)
        if not footage_is_shown(self, context, take):
            return {"CANCELLED"}
        segment = self._marker(take).segment
        context.window_manager.keymark_progress.show("", 0.0)
        self._masks_before = show_masks(context, False)  # the footage itself is what is clicked on
        context.window.cursor_modal_set("EYEDROPPER")
        ask(context, request_for(segment), "Esc: Cancel")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self._job is not None:
            return super().modal(context, event)
        if cancel_click(self, context, event):
            return {"CANCELLED"}
        follow_mouse(context, event)
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            return self._clicked(context, event)
        # Navigation: the animator may zoom in on the marker or go to another frame.
        return {"PASS_THROUGH"} if event.type in NAVIGATION else {"RUNNING_MODAL"}

    def _clicked(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        pixel = pixel_under(context, active_take(context.scene), event.mouse_x, event.mouse_y)
        if pixel is None:
            sentence = "That is not on the footage; click on a marker in it   |   Esc: Cancel"
            context.workspace.status_text_set(sentence)
            return {"RUNNING_MODAL"}
        self.pixel = pixel
        stop_asking(context)
        with reported(self):
            self.begin(context)
            return {"RUNNING_MODAL"}
        self.cancel(context)
        return {"CANCELLED"}

    def cancel(self, context: bpy.types.Context) -> None:
        stop_asking(context)
        if self._masks_before is not None:
            show_masks(context, self._masks_before)
        super().cancel(context)

    def start(self, scene: bpy.types.Scene) -> "Job[MarkerSearch]":
        """The color is read from the clip's file: the viewport's has gone through color management."""
        from ..bridge.footage_color import footage_color

        take = active_take(scene)
        name, color = self._marker(take).name, footage_color(footage_of(scene, take), self.pixel)
        return (yield from search_markers(scene, {name: color}))

    def finish(self, scene: bpy.types.Scene, result: MarkerSearch) -> None:
        write_search(scene, result, masks=self._masks_before is not None)
        ((name, color),) = result.colors.items()
        marker = next(each for each in take_by_identifier(scene, result.take).markers if each.name == name)
        for sentence in marker.warning.splitlines():
            warn(self, sentence)
        found = f"found in {marker.found} of {marker.sampled} frames"
        self.report({"INFO"}, f"Marker {name} has the color {color}, {found}")

    def _marker(self, take: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup:
        row = int(take.active_marker) if self.row < 0 else self.row
        return take.markers[min(row, len(take.markers) - 1)]


class KEYMARK_OT_check_markers(JobOperator, bpy.types.Operator):
    """Look for the markers in frames all over the clip: how large, distinct and reliably found each one is"""

    bl_idname = "keymark.check_markers"
    bl_label = "Check Markers"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, markers, picked_color, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[MarkerSearch]":
        return search_markers(scene)

    def finish(self, scene: bpy.types.Scene, result: MarkerSearch) -> None:
        warnings = write_search(scene, result)
        for sentence in warnings:
            warn(self, sentence)
        if not warnings:
            self.report({"INFO"}, f"All {len(result.styles)} markers with a color are found well")


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_OT_pick_marker_color, KEYMARK_OT_check_markers)
)
