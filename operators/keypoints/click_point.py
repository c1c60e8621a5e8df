"""Click on points of the body in the footage, frame by frame, where no detector finds them."""

from typing import Any

import bpy

from ...core.errors import InputError
from ...core.footage.keypoints.body_points import BODY_POINTS
from ..shell.base_operator import BaseOperator
from ..shell.click_sequence import ClickSequence
from ..shell.footage_clicks import footage_is_shown
from ..shell.footage_request import FootageRequest, side_of, stop_asking
from ..shell.redraw import redraw_footage, redraw_sidebars_soon
from ..shell.requirements import footage, idle
from ..shell.takes import active_take
from .body_point_items import body_point_items, point_title
from .clicks import clicked_here, set_click

KEYS = "Tab: Next Point   |   Backspace: Previous   |   Enter: Done   |   Esc: Cancel"


class KEYMARK_OT_click_point(ClickSequence, BaseOperator, bpy.types.Operator):
    """Click on points of the body in this frame, one after another; the arrow keys go to other frames"""

    bl_idname = "keymark.click_point"
    bl_label = "Click Points"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, idle)

    point: bpy.props.EnumProperty(
        name="Body Point",
        description="The point of the body; left and right are the performer's own",
        items=body_point_items(),
    )
    pixel: bpy.props.FloatVectorProperty(
        name="Pixel",
        description="Where it is, in pixels of the footage from its top left corner",
        size=2,
        options={"SKIP_SAVE"},
    )

    _before: Any = None
    """The chosen point and the clicks when the operator began; Blender would evaluate a type named here."""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for clicks on the footage, beginning with the point that is chosen in the panel."""
        take = active_take(context.scene)
        if not footage_is_shown(self, context, take):
            return {"CANCELLED"}
        self._before = take.follow.clicked_point, _all_clicks(take)
        return self.wait_for_clicks(context)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take clicks until Enter, or a click beside the footage; Esc takes all of them back."""
        return self.take_event(context, event)

    def request(self, context: bpy.types.Context) -> tuple[FootageRequest, str]:
        """The point that is chosen in the panel."""
        point = active_take(context.scene).follow.clicked_point
        title = f"Click on: {point_title(point)}"
        return FootageRequest(title, side_of(point)), KEYS

    def clicked(self, context: bpy.types.Context, pixel: tuple[float, float]) -> set[str]:
        """Set the point, and ask for the next one; the same points may be clicked on in other frames."""
        take = active_take(context.scene)
        set_click(take, take.follow.clicked_point, pixel)
        _choose_next(take)
        self.ask(context)
        return {"RUNNING_MODAL"}

    def go_on(self, context: bpy.types.Context) -> None:
        """Choose the next point that has no click in this frame."""
        _choose_next(active_take(context.scene))

    def go_back(self, context: bpy.types.Context) -> None:
        """Choose the point before; a click on it takes the place of an earlier one."""
        follow = active_take(context.scene).follow
        follow.clicked_point = BODY_POINTS[BODY_POINTS.index(follow.clicked_point) - 1]

    def done(self, context: bpy.types.Context) -> set[str]:
        """Keep the clicks, as one step of undo; without any nothing has happened."""
        take = active_take(context.scene)
        changed = _all_clicks(take) != self._before[1]
        self._before = None
        self.cancel(context)
        if not changed:
            return {"CANCELLED"}
        self.report({"INFO"}, f"{len(clicked_here(take))} points are clicked on in this frame")
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Restore cursor and clicks; Blender calls this as well."""
        if self._before is not None:
            follow = active_take(context.scene).follow
            follow.clicked_point, clicks = self._before
            follow.clicks.clear()
            for point, frame, pixel in clicks:
                click = follow.clicks.add()
                click.point, click.frame, click.pixel = point, frame, pixel
            self._before = None
        stop_asking(context)
        redraw_sidebars_soon()

    def run(self, context: bpy.types.Context) -> None:
        """Set one point in the current frame.

        Raises:
            InputError: The pixel lies outside the footage.
        """
        take = active_take(context.scene)
        width, height = take.clip.size
        if not (0.0 <= self.pixel[0] <= width and 0.0 <= self.pixel[1] <= height):
            x, y = self.pixel
            raise InputError(
                f"pixel ({x:g}, {y:g}) lies outside the footage, which is {width} x {height} pixels"
            )
        set_click(take, self.point, tuple(self.pixel))
        redraw_footage(context)


def _all_clicks(take: bpy.types.PropertyGroup) -> list[tuple[str, int, tuple[float, ...]]]:
    return [(click.point, click.frame, tuple(click.pixel)) for click in take.follow.clicks]


def _choose_next(take: bpy.types.PropertyGroup) -> None:
    """Choose the next point in the order of the menu that was not clicked on in this frame yet."""
    begun = BODY_POINTS.index(take.follow.clicked_point) + 1
    done = clicked_here(take)
    order = (*BODY_POINTS[begun:], *BODY_POINTS[:begun])
    take.follow.clicked_point = next((point for point in order if point not in done), order[0])


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_click_point,))
