"""Regions of the picture that are never a marker: the brush over the footage, and still areas."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator, reported, warn
from ..shell.fields import SKIP_SAVE, Entries, Number
from ..shell.footage_clicks import ClickSequence, footage_is_shown
from ..shell.footage_view import FootageRequest, follow_mouse, pixel_under, stop_asking
from ..shell.job_operator import JobOperator
from ..shell.requirements import footage, idle, markers
from ..shell.takes import active_take, find_take, redraw_footage
from .marker_properties import clear_readouts
from .marker_styles import MarkerSearch, search_markers, write_search
from .mask_previews import preview_of, show_masks, update_masks

if TYPE_CHECKING:
    from ...core.markers.ignored_regions import IgnoredRegion
    from ...core.progress import Job


Pixel = tuple[float, float]

SMALLEST_PX = 1.0  # Smallest radius of the brush


@dataclass
class Brush:
    """A brush at work."""

    width: int  # Width of the footage in px
    radius_px: float = 0.0  # Its radius in pixels of the footage; 0 for the usual one
    strokes: "list[tuple[float, list[Pixel]]]" = field(default_factory=list)
    """Radius and points of each stroke."""
    is_down: bool = False

    def __post_init__(self) -> None:
        self.radius_px = self.radius_px or max(0.03 * self.width, SMALLEST_PX)

    def press(self, pixel: Pixel) -> None:
        self.strokes.append((self.radius_px, [pixel]))
        self.is_down = True

    def move(self, pixel: Pixel, most_points: int) -> None:
        """Go on with the stroke; a long one goes on as another."""
        radius, points = self.strokes[-1]
        if np.hypot(pixel[0] - points[-1][0], pixel[1] - points[-1][1]) < 0.25 * radius:
            return  # nearer points would not be seen
        if len(points) >= most_points:
            self.strokes.append((radius, [points[-1]]))
        self.strokes[-1][1].append(pixel)

    def grow(self, steps: int) -> None:
        """Make it larger, or smaller with fewer than no steps."""
        self.radius_px = float(np.clip(self.radius_px * 1.25**steps, SMALLEST_PX, 0.5 * self.width))

    def regions(self) -> "tuple[IgnoredRegion, ...]":
        from ...core.markers.ignored_regions import IgnoredRegion

        return tuple(IgnoredRegion(stroke=tuple(points), radius_px=radius) for radius, points in self.strokes)


_brush: Brush | None = None


def take_brush(brush: Brush | None) -> None:
    """Set the brush that is at work; None for none."""
    global _brush
    _brush = brush


def brush_at_work() -> Brush | None:
    """The brush that is at work; None for none."""
    return _brush


def still_areas(context: bpy.types.Context) -> str | None:
    """Some still area of a marker's color is known that is surely no marker."""
    take = find_take(context.scene)
    if take and any(marker.has_readout(take) and len(marker.still_areas) for marker in take.markers):
        return None
    return "Check the markers first; no still area of a marker's color is known"


def some_ignored(context: bpy.types.Context) -> str | None:
    """Some region of the picture is ignored."""
    take = find_take(context.scene)
    return None if take and len(take.ignored_regions) else "No region of the picture is left out"


KEYS = "[  ]: Brush Size   |   Backspace: Back   |   Enter: Done   |   Esc: Cancel"
SIZES = {"LEFT_BRACKET": -1, "RIGHT_BRACKET": 1}


class KEYMARK_OT_ignore_region(JobOperator, ClickSequence, bpy.types.Operator):
    """Brush over what has a marker's color and is none, as a wall or a chair; it is never taken for one"""

    bl_label = "Not This"
    requirements = (footage, markers, idle)
    cursor = "PAINT_CROSS"
    ends_beside = False

    path: Entries(
        name="Path",
        description="Pixels of the footage under the brush; a new stroke begins with another time",
        type=bpy.types.OperatorMousePath,
        options=SKIP_SAVE,
    )
    radius: Number(
        "Radius", "The brush's radius in pixels of the footage", default=10.0, min=0.5, options=SKIP_SAVE
    )

    _masks_before: bool | None = None  # Whether masks were shown before; None in a script
    _brushed: Any = None
    """The regions that were brushed; None in a script. Blender would evaluate a type named here."""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        take = active_take(context.scene)
        if not footage_is_shown(self, context, take):
            return {"CANCELLED"}
        context.window_manager.keymark_progress.show("", 0.0)
        with reported(self):
            update_masks(context.scene)
        self._masks_before = show_masks(context, preview_of(take) is not None)
        take_brush(Brush(take.clip.size[0]))
        self.wait_for_clicks(context)
        follow_mouse(context, event)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Brush until Enter, then look for the markers anew; Esc takes all strokes back."""
        if self._job is not None:
            return super().modal(context, event)
        brush = brush_at_work()
        if brush is None:  # another file was opened
            return {"CANCELLED"}
        if brush.is_down and event.type == "MOUSEMOVE":
            self._move(context, brush, event)
        elif event.type == "LEFTMOUSE" and event.value == "RELEASE":
            brush.is_down = False
        elif event.type in SIZES and event.value == "PRESS":
            brush.grow(SIZES[event.type])
            self.ask(context)
            return {"RUNNING_MODAL"}
        return self.take_event(context, event)

    def request(self, context: bpy.types.Context) -> tuple[FootageRequest, str]:
        brush = brush_at_work()
        radius = 0.0 if brush is None else brush.radius_px
        detail = "as a wall or a chair of a marker's color"
        return FootageRequest("Brush over what is no marker", detail, radius), KEYS

    def clicked(self, context: bpy.types.Context, pixel: tuple[float, float]) -> set[str]:
        brush = brush_at_work()
        if brush is not None:
            brush.press(pixel)
            redraw_footage(context)
        return {"RUNNING_MODAL"}

    def go_back(self, context: bpy.types.Context) -> None:
        brush = brush_at_work()
        if brush is not None and brush.strokes:
            brush.strokes.pop()
            brush.is_down = False

    def done(self, context: bpy.types.Context) -> set[str]:
        brush = brush_at_work()
        self._brushed = () if brush is None else brush.regions()
        if brush is None or not brush.strokes:
            self.cancel(context)
            return {"CANCELLED"}
        self._keep_path(brush)
        stop_asking(context)
        with reported(self):
            self.begin(context)
            return {"RUNNING_MODAL"}
        self.cancel(context)
        return {"CANCELLED"}

    def cancel(self, context: bpy.types.Context) -> None:
        take_brush(None)
        stop_asking(context)
        if self._masks_before is not None:
            show_masks(context, self._masks_before)
        super().cancel(context)

    def start(self, scene: bpy.types.Scene) -> "Job[MarkerSearch]":
        brushed = self._from_path(active_take(scene)) if self._brushed is None else self._brushed
        return search_markers(scene, more=brushed)

    def finish(self, scene: bpy.types.Scene, result: MarkerSearch) -> None:
        for sentence in write_search(
            scene, result, masks=bool(self._masks_before is not None and result.check)
        ):
            warn(self, sentence)
        self.report({"INFO"}, f"Brushed regions are never a marker: {len(result.more)} more")

    def _move(self, context: bpy.types.Context, brush: Brush, event: bpy.types.Event) -> None:
        from ...core.markers.ignored_regions import MOST_POINTS

        pixel = pixel_under(context, active_take(context.scene), event.mouse_x, event.mouse_y)
        if pixel is not None:
            brush.move(pixel, MOST_POINTS)

    def _keep_path(self, brush: Brush) -> None:
        self.path.clear()
        self.radius = brush.radius_px
        for number, (_, points) in enumerate(brush.strokes):
            for pixel in points:
                point = self.path.add()
                point.loc, point.time = pixel, number

    def _from_path(self, take: bpy.types.PropertyGroup) -> "tuple[IgnoredRegion, ...]":
        """The strokes that the properties say."""
        if not len(self.path):
            raise InputError("path is empty; give at least one pixel of the footage")
        brush, stroke = Brush(take.clip.size[0], self.radius), None
        for point in self.path:
            if point.time != stroke:
                brush.press(tuple(point.loc))
            else:
                brush.strokes[-1][1].append(tuple(point.loc))
            stroke = point.time
        return brush.regions()


class KEYMARK_OT_ignore_still_areas(JobOperator, bpy.types.Operator):
    """Leave out what keeps a marker's color in the same pixels while the marker moves: it is surely none"""

    bl_idname = "keymark.ignore_still_areas"
    bl_label = "Ignore Still Areas"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, markers, still_areas, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[MarkerSearch]":
        from ...core.markers.ignored_regions import IgnoredRegion

        take = active_take(scene)
        boxes = [
            tuple(area.box)
            for marker in take.markers
            if marker.has_readout(take)
            for area in marker.still_areas
        ]
        return search_markers(scene, more=tuple(IgnoredRegion(box=box) for box in dict.fromkeys(boxes)))

    def finish(self, scene: bpy.types.Scene, result: MarkerSearch) -> None:
        for sentence in write_search(scene, result):
            warn(self, sentence)
        self.report({"INFO"}, f"Still areas are never a marker: {len(result.more)} more")


class KEYMARK_OT_remove_ignored_region(BaseOperator, bpy.types.Operator):
    """Search the chosen region of the picture for markers again"""

    bl_idname = "keymark.remove_ignored_region"
    bl_label = "Remove Region"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (some_ignored, idle)

    def run(self, context: bpy.types.Context) -> None:
        take = active_take(context.scene)
        index = min(take.active_ignored, len(take.ignored_regions) - 1)
        take.ignored_regions.remove(index)
        take.active_ignored = max(0, index - 1)
        clear_readouts(take)
        redraw_footage(context)
