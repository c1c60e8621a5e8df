"""Points of the body that a person clicks on in the frames of a take, or names a motion track after."""

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
from bpy.types import Context, PropertyGroup

from ...core.body.human import HUMAN
from ...core.detect.keypoints import BODY_POINTS
from ...core.detect.layouts import named_point
from ...core.errors import InputError
from ..bridge.scene_evidence import clip_tracks
from ..shell import need
from ..shell.base_operator import BaseOperator, Unchanged
from ..shell.fields import SKIP_SAVE, Choice, Pixel, Text
from ..shell.footage_view import ClickSequence, FootageRequest, side_of
from ..shell.takes import active_take, redraw_footage, redraw_sidebars_soon
from .evidence import clicked_here, clicked_points, clip_frame, keypoints_at
from .properties import NO_POINT, body_point_items, segment_title


def set_click(take: PropertyGroup, point: str, pixel: Sequence[float], frame: int) -> None:
    """Set where a point is in a frame of the clip, in place of an earlier click."""
    remove_click(take, point, frame)
    click = take.follow.clicks.add()
    click.point, click.frame, click.pixel = point, frame, pixel


def remove_click(take: PropertyGroup, point: str, frame: int) -> bool:
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
    requirements = (need.footage, need.idle)

    point: Choice("Body Point", "The point; left and right are the performer's own", items=body_point_items())
    pixel: Pixel("Pixel", "Where it is")

    _before: Any = None
    """The chosen point and the clicks when the operator began; Blender would evaluate a type named here."""

    def prepare(self, context: Context, take: PropertyGroup) -> None:
        self._before = take.follow.clicked_point, clicked_points(take)

    def request(self, context: Context) -> tuple[FootageRequest, str]:
        point = active_take(context.scene).follow.clicked_point
        return FootageRequest(f"Click on: {segment_title(point)}", side_of(point)), KEYS

    def clicked(self, context: Context, pixel: tuple[float, float]) -> set[str]:
        take = active_take(context.scene)
        set_click(take, take.follow.clicked_point, pixel, clip_frame(take))
        self.go_on(context)
        self.ask(context)
        return {"RUNNING_MODAL"}

    def go_on(self, context: Context) -> None:
        """Choose the next point in the order of the menu that was not clicked on in this frame yet."""
        take = active_take(context.scene)
        begun, done = BODY_POINTS.index(take.follow.clicked_point) + 1, clicked_here(take)
        order = (*BODY_POINTS[begun:], *BODY_POINTS[:begun])
        take.follow.clicked_point = next((point for point in order if point not in done), order[0])

    def go_back(self, context: Context) -> None:
        """Choose the point before; a click on it takes the place of an earlier one."""
        follow = active_take(context.scene).follow
        follow.clicked_point = BODY_POINTS[BODY_POINTS.index(follow.clicked_point) - 1]

    def done(self, context: Context) -> set[str]:
        """Keep the clicks, as one step of undo; without any nothing has happened."""
        take = active_take(context.scene)
        changed = clicked_points(take) != self._before[1]
        self._before = None
        self.cancel(context)
        if not changed:
            return {"CANCELLED"}
        self.report({"INFO"}, f"{len(clicked_here(take))} points are clicked on in this frame")
        return {"FINISHED"}

    def cancel(self, context: Context) -> None:
        if self._before is not None:
            take = active_take(context.scene)
            take.follow.clicked_point, clicks = self._before
            take.follow.clicks.clear()
            for click in clicks:
                set_click(take, click.point, click.pixel, click.frame)
            self._before = None
        super().cancel(context)
        redraw_sidebars_soon()

    def run(self, context: Context) -> None:
        take, (x, y) = active_take(context.scene), self.pixel
        width, height = take.clip.size
        if not (0.0 <= x <= width and 0.0 <= y <= height):
            extent = f"{width} x {height} pixels"
            raise InputError(f"pixel ({x:g}, {y:g}) lies outside the footage, which is {extent}")
        set_click(take, self.point, (x, y), clip_frame(take))
        redraw_footage(context)


class KEYMARK_OT_remove_clicks(BaseOperator, bpy.types.Operator):
    """Remove this point in this frame, or all points that were clicked on in this frame"""

    bl_label = "Remove Clicked Points"
    requirements = (need.footage, need.idle)

    point: Text("Body Point", "The point to remove; empty for all", options=SKIP_SAVE)

    def run(self, context: Context) -> None:
        take = active_take(context.scene)
        points = [self.point] if self.point else clicked_here(take)
        removed = [point for point in points if remove_click(take, point, clip_frame(take))]
        if not removed:
            raise Unchanged("nothing was clicked on in this frame")
        redraw_footage(context)


class KEYMARK_OT_click_performer(ClickSequence, BaseOperator, bpy.types.Operator):
    """Click on the performer in a frame in which a detector sees several people; one frame is often enough"""

    bl_label = "Click on the Performer"
    requirements = (need.footage, need.keypoint_files, need.idle)

    pixel: Pixel("Pixel", "Where the performer is")

    def request(self, context: Context) -> tuple[FootageRequest, str]:
        return FootageRequest("Click on the performer"), "Esc: Cancel"

    def clicked(self, context: Context, pixel: tuple[float, float]) -> set[str]:
        self.cancel(context)
        self.pixel = pixel
        return self.execute(context)

    def run(self, context: Context) -> None:
        """Vouch for the seen joint that is nearest to the click: points by hand are the performer's."""
        take, frame = active_take(context.scene), context.scene.frame_current
        seen = [
            (float(np.linalg.norm(place - np.array(self.pixel))), name, place.tolist())
            for source in keypoints_at(take, frame)
            for column, name in enumerate(source.names)
            for place in source.pixel[:, column]
            if name in HUMAN.point_names and np.isfinite(place).all()
        ]
        if not seen:
            raise InputError(
                f"no detector sees anybody in frame {frame}; go to one in which the performer is seen"
            )
        _, point, pixel = min(seen)
        set_click(take, point, pixel, clip_frame(take))
        redraw_footage(context)
        self.report({"INFO"}, f"The performer is known by the point {segment_title(point)}")


class KEYMARK_OT_assign_track(BaseOperator, bpy.types.Operator):
    """Choose the body point that this motion track follows; tracks that are named after one need no choice"""

    bl_label = "Assign Track"
    requirements = (need.footage, need.idle)

    owner: Text("Object", "Name of the tracking object that the track belongs to")
    track: Text("Track", "Name of the motion track")
    point: Choice(
        "Body Point",
        "The body point that the track follows; left and right are the performer's own",
        items=body_point_items("No Body Point"),
    )

    def run(self, context: Context) -> None:
        take = active_take(context.scene)
        if (self.owner, self.track) not in {(owner, track.name) for owner, track in clip_tracks(take.clip)}:
            raise InputError(f"clip '{take.clip.name}' has no track '{self.track}' of object '{self.owner}'")
        choices, point = take.follow.tracks, "" if self.point == NO_POINT else self.point
        for number in reversed(range(len(choices))):
            if (choices[number].owner, choices[number].track) == (self.owner, self.track):
                choices.remove(number)
        if point != (named_point(self.track) or ""):
            choice = choices.add()
            choice.owner, choice.track, choice.point = self.owner, self.track, point
        redraw_footage(context)
