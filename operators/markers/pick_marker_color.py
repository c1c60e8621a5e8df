"""Pick a marker's color from the footage, and see at once how well it is found."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..shell.error_reports import reported
from ..shell.footage_clicks import NAVIGATION, footage_is_shown
from ..shell.footage_view import pixel_under
from ..shell.job_operator import JobOperator
from ..shell.messages import label, say
from ..shell.redraw import redraw_footage
from ..shell.requirements import all_met, footage, idle
from ..shell.takes import active_take, footage_of, take_called
from .add_marker import append_marker, free_name, next_segment
from .check_markers import show_frame
from .marker_readouts import check_unchanged, look_at_markers, write_readouts
from .marker_styles import marker_styles, set_marker_color
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
    """What a click found."""

    take: str
    """The take's identifier."""
    index: int | None
    """Which marker gets the color; None for a new one."""
    color: tuple[int, int, int]
    styles: "tuple[MarkerStyle, ...]"
    check: "MarkerCheck"


class KEYMARK_OT_pick_marker_color(JobOperator, bpy.types.Operator):
    """Click on the marker in the footage to take its color from there, and look for it all over the clip"""

    bl_idname = "keymark.pick_marker_color"
    bl_label = "Pick Marker Color"
    bl_options = {"REGISTER", "UNDO"}

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
    """Whether masks were shown when the eyedropper was taken up; None in a script, which sees none."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be footage."""
        return all_met(cls, context, footage, idle)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The tooltip: which marker gets the color."""
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
        """Wait for a click on the footage, then go on with the job that it starts."""
        if self._job is not None:
            return super().modal(context, event)
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            return self._clicked(context, event)
        # What moves the view lets the animator go nearer to the marker or to another frame.
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
        """Give the cursor back and stop the job; Blender calls this as well."""
        if self._job is None and context.window is not None:
            context.window.cursor_modal_restore()
        if self._masks_before is not None:
            _show_masks(context, self._masks_before)
        super().cancel(context)

    def start(self, scene: bpy.types.Scene) -> "Job[Picked]":
        """Read the pixel from the footage's file, free of the viewport's colors; look for its color."""
        from ..bridge.footage_color import footage_color

        take = active_take(scene)
        source, identifier, index = footage_of(scene, take), take.identifier, self._index(take)
        color = footage_color(source, self.pixel)
        styles = _styles(take, index, color)
        check = yield from look_at_markers(source, styles)
        return Picked(identifier, index, color, styles, check)

    def finish(self, scene: bpy.types.Scene, result: Picked) -> None:
        """Give the color to the marker, and store what was found of all of them."""
        take = take_called(scene, result.take)
        check_unchanged(_styles(take, result.index, result.color), result.styles)
        if result.index is None:
            marker = append_marker(take, result.styles[-1].segment)
        else:
            marker = take.markers[result.index]
        set_marker_color(marker, result.color)
        write_readouts(take, result.styles, result.check)
        if self._masks_before is not None:  # picked by a click: what would be found of it is seen at once
            _show_masks(bpy.context, True)
        show_frame(scene)
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
        """The marker whose color is picked; None for a new one."""
        if self.add or not len(take.markers):
            return None
        return min(int(take.active_marker), len(take.markers) - 1)

    def _segment(self, take: bpy.types.PropertyGroup) -> str | None:
        """The body part whose marker is picked; None where there is none left to add one on."""
        index = self._index(take)
        return next_segment(take) if index is None else str(take.markers[index].segment)


def _show_masks(context: bpy.types.Context, shown: bool) -> None:
    context.window_manager.keymark_show_masks = shown
    redraw_footage(context)


def _styles(
    take: bpy.types.PropertyGroup, picked: int | None, color: tuple[int, int, int]
) -> "tuple[MarkerStyle, ...]":
    """The markers as they will be.

    Args:
        take: Whose markers.
        picked: Which of them gets the color; None for a new one.
        color: Red, green, blue in 0 to 255.

    Raises:
        InputError: Two markers have one name or one segment, or every body part has one.
    """
    from ...core.footage.marker_style import MarkerStyle

    styles = [
        replace(style, color_srgb=color) if index == picked else style
        for index, style in enumerate(marker_styles(take))
        if index == picked or take.markers[index].is_picked
    ]
    if picked is None:
        segment = next_segment(take)
        if segment is None:
            raise InputError("every body part has a marker already; choose the one to pick a color for")
        styles.append(MarkerStyle(free_name(take, segment), segment, color))
    return tuple(styles)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_pick_marker_color,))
