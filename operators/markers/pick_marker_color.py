"""Pick a marker's color from the footage, and check at once how well the marker is found."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ..shell.cancel_on_esc import cancel_click
from ..shell.error_reports import reported
from ..shell.footage_clicks import NAVIGATION, footage_is_shown
from ..shell.footage_view import pixel_under
from ..shell.job_operator import JobOperator
from ..shell.messages import label, say
from ..shell.redraw import redraw_footage
from ..shell.requirements import footage, idle
from ..shell.takes import active_take, footage_of, take_by_identifier
from .marker_readouts import check_unchanged, find_markers, write_readouts
from .marker_styles import Rgb, set_marker_color, styles_with_color
from .mask_previews import update_shown_masks
from .new_markers import append_marker, next_segment
from .properties import segment_title

if TYPE_CHECKING:
    from ...core.footage.marker_check import MarkerCheck
    from ...core.footage.marker_style import MarkerStyle
    from ...core.progress import Job

REQUESTS = {
    ".L": "Click on the marker: {segment}, the performer's own left",
    ".R": "Click on the marker: {segment}, the performer's own right",
}
MIDDLE_REQUEST = "Click on the marker: {segment}"


@dataclass(frozen=True, eq=False)
class Picked:
    """Result of the job."""

    take: str
    """The take's identifier."""
    index: int | None
    """The marker that is given the color; None for a new one."""
    color: Rgb
    styles: "tuple[MarkerStyle, ...]"
    check: "MarkerCheck"


class KEYMARK_OT_pick_marker_color(JobOperator, bpy.types.Operator):
    """Click on the marker in the footage to take its color from there, and look for it all over the clip"""

    bl_idname = "keymark.pick_marker_color"
    bl_label = "Pick Marker Color"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, idle)

    pixel: bpy.props.FloatVectorProperty(
        name="Pixel",
        description="Where to pick, in pixels of the footage from its top left corner",
        size=2,
        options={"SKIP_SAVE"},
    )
    add: bpy.props.BoolProperty(
        name="Add",
        description="Give the color to a new marker on the next body part instead of the active one",
        default=False,
        options={"SKIP_SAVE"},
    )

    _masks_before: bool | None = None
    """Whether masks were shown before the eyedropper; None in a script, which shows none."""

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip, which says which marker is given the color."""
        if properties.add:
            return "Click on another marker in the footage, to add it on the next body part in its color"
        return "Click on the active marker in the footage, to take its color from there and look for it"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for a click on the footage."""
        take = active_take(context.scene)
        if not footage_is_shown(self, context, take):
            return {"CANCELLED"}
        segment = self._segment(take)
        if segment is None:
            say(self, "ERROR", "Every body part has a marker already")
            return {"CANCELLED"}
        sentence = label(REQUESTS.get(segment[-2:], MIDDLE_REQUEST), segment=label(segment_title(segment)))
        manager = context.window_manager
        manager.keymark_progress.show("", 0.0)
        self._masks_before = manager.keymark_show_masks
        _show_masks(context, False)  # the footage itself is what is clicked on
        context.workspace.status_text_set(label("{sentence}   |   Esc: Cancel", sentence=sentence))
        context.window.cursor_modal_set("EYEDROPPER")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for a click on the footage, then run the job that it starts."""
        if self._job is not None:
            return super().modal(context, event)
        if cancel_click(self, context, event):
            return {"CANCELLED"}
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            return self._clicked(context, event)
        # Navigation: the animator may zoom in on the marker or go to another frame.
        return {"PASS_THROUGH"} if event.type in NAVIGATION else {"RUNNING_MODAL"}

    def _clicked(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        pixel = pixel_under(context, active_take(context.scene), event.mouse_x, event.mouse_y)
        if pixel is None:
            sentence = label("That is not on the footage; click on a marker in it   |   Esc: Cancel")
            context.workspace.status_text_set(sentence)
            return {"RUNNING_MODAL"}
        self.pixel = pixel
        context.window.cursor_modal_restore()
        with reported(self):
            self.begin(context)
            return {"RUNNING_MODAL"}
        self.cancel(context)
        return {"CANCELLED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Restore cursor and masks, and close the job; Blender calls this as well."""
        if self._job is None and context.window is not None:
            context.window.cursor_modal_restore()
        if self._masks_before is not None:
            _show_masks(context, self._masks_before)
        super().cancel(context)

    def start(self, scene: bpy.types.Scene) -> "Job[Picked]":
        """Return the job that reads the pixel from the clip's file and looks for its color.

        The viewport's own pixel has gone through color management.
        """
        from ..bridge.footage_color import footage_color

        take = active_take(scene)
        source, identifier, index = footage_of(scene, take), take.identifier, self._index(take)
        color = footage_color(source, self.pixel)
        styles = styles_with_color(take, index, color)
        check = yield from find_markers(source, styles)
        return Picked(identifier, index, color, styles, check)

    def finish(self, scene: bpy.types.Scene, result: Picked) -> None:
        """Give the marker its color, and store the readouts of all markers."""
        take = take_by_identifier(scene, result.take)
        check_unchanged(styles_with_color(take, result.index, result.color), result.styles)
        if result.index is None:
            marker = append_marker(take, result.styles[-1].segment)
        else:
            marker = take.markers[result.index]
        set_marker_color(marker, result.color)
        write_readouts(take, result.styles, result.check)
        if self._masks_before is not None:  # picked by a click: its mask is shown at once
            _show_masks(bpy.context, True)
        update_shown_masks(scene)
        for sentence in marker.warning.splitlines():
            self.report({"WARNING"}, sentence)
        say(
            self,
            "INFO",
            "Marker {name} has the color {color}, found in {found} of {sampled} frames",
            name=marker.name,
            color=result.color,
            found=marker.found,
            sampled=marker.sampled,
        )

    def _index(self, take: bpy.types.PropertyGroup) -> int | None:
        """Return the index of the marker whose color is picked; None for a new one."""
        if self.add or not len(take.markers):
            return None
        return min(int(take.active_marker), len(take.markers) - 1)

    def _segment(self, take: bpy.types.PropertyGroup) -> str | None:
        """Return the segment whose marker is picked; None if there is none left for a new marker."""
        index = self._index(take)
        return next_segment(take) if index is None else str(take.markers[index].segment)


def _show_masks(context: bpy.types.Context, shown: bool) -> None:
    context.window_manager.keymark_show_masks = shown
    redraw_footage(context)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_pick_marker_color,))
