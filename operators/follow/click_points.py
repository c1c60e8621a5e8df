"""Points of the body that a person clicks on in the frames of a take."""

from typing import Any

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.detect.keypoints import BODY_POINTS
from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.fields import SKIP_SAVE, Choice, Text, Vector
from ..shell.footage_clicks import ClickSequence
from ..shell.footage_view import FootageRequest, side_of, stop_asking
from ..shell.requirements import footage, idle
from ..shell.takes import active_take, redraw_footage, redraw_sidebars_soon
from .evidence import clicked_here, clip_frame, keypoint_files
from .frame_keypoints import keypoints_at
from .marker_properties import segment_title
from .tracks import body_point_items


def set_click(
    take: bpy.types.PropertyGroup, point: str, pixel: tuple[float, float], frame: int | None = None
) -> None:
    """Set where a point is in a frame, the current one by default, in place of an earlier click."""
    at = clip_frame(take) if frame is None else frame
    remove_click(take, point, at)
    click = take.follow.clicks.add()
    click.point, click.frame, click.pixel = point, at, pixel


def remove_click(take: bpy.types.PropertyGroup, point: str, frame: int) -> bool:
    """Remove the click on a point in a frame; return whether there was one."""
    clicks = take.follow.clicks
    found = [i for i in range(len(clicks)) if (clicks[i].point, clicks[i].frame) == (point, frame)]
    for index in reversed(found):
        clicks.remove(index)
    return bool(found)


KEYS = "Tab: Next Point   |   Backspace: Previous   |   Enter: Done   |   Esc: Cancel"


class KEYMARK_OT_click_point(ClickSequence, BaseOperator, bpy.types.Operator):
    """Click on points of the body in this frame, one after another; the arrow keys go to other frames"""

    bl_label = "Click Points"
    requirements = (footage, idle)

    point: Choice(
        "Body Point",
        "The point of the body; left and right are the performer's own",
        items=body_point_items(),
    )
    pixel: Vector(
        "Pixel", "Where it is, in pixels of the footage from its top left corner", size=2, options=SKIP_SAVE
    )

    _before: Any = None
    """The chosen point and the clicks when the operator began; Blender would evaluate a type named here."""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        take = active_take(context.scene)
        self._before = take.follow.clicked_point, _all_clicks(take)
        return super().invoke(context, event)

    def request(self, context: bpy.types.Context) -> tuple[FootageRequest, str]:
        point = active_take(context.scene).follow.clicked_point
        title = f"Click on: {segment_title(point)}"
        return FootageRequest(title, side_of(point)), KEYS

    def clicked(self, context: bpy.types.Context, pixel: tuple[float, float]) -> set[str]:
        take = active_take(context.scene)
        set_click(take, take.follow.clicked_point, pixel)
        _choose_next(take)
        self.ask(context)
        return {"RUNNING_MODAL"}

    def go_on(self, context: bpy.types.Context) -> None:
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
        take = active_take(context.scene)
        width, height = take.clip.size
        if not (0.0 <= self.pixel[0] <= width and 0.0 <= self.pixel[1] <= height):
            x, y = self.pixel
            extent = f"{width} x {height} pixels"
            raise InputError(f"pixel ({x:g}, {y:g}) lies outside the footage, which is {extent}")
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


class KEYMARK_OT_remove_clicks(BaseOperator, bpy.types.Operator):
    """Remove this point in this frame, or all points that were clicked on in this frame"""

    bl_idname = "keymark.remove_clicks"
    bl_label = "Remove Clicked Points"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, idle)

    point: Text("Body Point", "The point to remove; empty for all", options=SKIP_SAVE)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        take = active_take(context.scene)
        here = clip_frame(take)
        points = [self.point] if self.point else clicked_here(take)
        removed = [point for point in points if remove_click(take, point, here)]
        if not removed:
            self.report({"INFO"}, "Nothing was clicked on in this frame")
            return {"CANCELLED"}
        redraw_footage(context)
        return None


class KEYMARK_OT_click_performer(ClickSequence, BaseOperator, bpy.types.Operator):
    """Click on the performer in a frame in which a detector sees several people; one frame is often enough"""

    bl_idname = "keymark.click_performer"
    bl_label = "Click on the Performer"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, keypoint_files, idle)

    pixel: Vector(
        "Pixel",
        "Where the performer is, in pixels of the footage from its top left corner",
        size=2,
        options=SKIP_SAVE,
    )

    def request(self, context: bpy.types.Context) -> tuple[FootageRequest, str]:
        return FootageRequest("Click on the performer"), "Esc: Cancel"

    def clicked(self, context: bpy.types.Context, pixel: tuple[float, float]) -> set[str]:
        self.cancel(context)
        self.pixel = pixel
        return self.execute(context)

    def run(self, context: bpy.types.Context) -> None:
        """Vouch for the seen point that is nearest to the click: points by hand are the performer's."""
        take = active_take(context.scene)
        found = nearest_point(take, context.scene.frame_current, np.array(self.pixel))
        if found is None:
            nobody = f"no detector sees anybody in frame {context.scene.frame_current}"
            raise InputError(f"{nobody}; go to one in which the performer is seen")
        point, pixel = found
        set_click(take, point, pixel)
        redraw_footage(context)
        self.report({"INFO"}, f"The performer is known by the point {segment_title(point)}")


def nearest_point(
    take: bpy.types.PropertyGroup, scene_frame: int, pixel: Array
) -> tuple[str, tuple[float, float]] | None:
    """The joint of anyone in a frame that is seen nearest to a pixel, and its place [px]; None for nobody."""
    best: tuple[float, str, tuple[float, float]] | None = None
    for source in keypoints_at(take, scene_frame):
        for column, name in enumerate(source.names):
            places = source.pixel[:, column]
            away = np.linalg.norm(places - pixel, axis=-1)
            if name not in HUMAN.point_names or not np.isfinite(away).any():
                continue
            row = int(np.nanargmin(away))
            if best is None or away[row] < best[0]:
                best = float(away[row]), name, (float(places[row, 0]), float(places[row, 1]))
    return None if best is None else best[1:]
