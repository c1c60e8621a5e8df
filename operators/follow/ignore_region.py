"""The brush over regions of the picture that are never a marker."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

import bpy
import numpy as np
from bpy.types import Context, Event, PropertyGroup, Scene

from ...core.errors import InputError
from ...core.markers import ignored_regions
from ...core.markers.ignored_regions import IgnoredRegion
from ...core.progress import Job
from ..shell.base_operator import reported
from ..shell.fields import SKIP_SAVE, Entries, Number
from ..shell.footage_view import FootageRequest, pixel_under
from ..shell.requirements import footage, idle, markers
from ..shell.takes import active_take, redraw_footage
from .marker_search import MarkerSearch, search_markers, write_and_warn
from .mask_previews import preview_of, show_masks, update_masks
from .pick_marker_color import MarkerTool

Pixel = tuple[float, float]


@dataclass
class Brush:
    """A brush that draws strokes."""

    at_work: "ClassVar[Brush | None]" = None
    width: int  # Width of the footage in px
    radius_px: float = 0.0  # Its radius in pixels of the footage; 0 for the usual one
    strokes: list[tuple[float, list[Pixel]]] = field(default_factory=list)
    """Radius and points of each stroke."""
    is_down: bool = False

    def __post_init__(self) -> None:
        self.radius_px = self.radius_px or max(0.03 * self.width, 1.0)

    def press(self, pixel: Pixel) -> None:
        self.strokes.append((self.radius_px, [pixel]))
        self.is_down = True

    def move(self, pixel: Pixel) -> None:
        """Go on with the stroke; a long one goes on as another."""
        radius, points = self.strokes[-1]
        if np.hypot(pixel[0] - points[-1][0], pixel[1] - points[-1][1]) < 0.25 * radius:
            return  # nearer points would not be seen
        if len(points) >= ignored_regions.MOST_POINTS:
            self.strokes.append((radius, [points[-1]]))
        self.strokes[-1][1].append(pixel)

    def grow(self, steps: int) -> None:
        """Make it larger, or smaller with fewer than no steps."""
        self.radius_px = float(np.clip(self.radius_px * 1.25**steps, 1.0, 0.5 * self.width))

    def regions(self) -> tuple[IgnoredRegion, ...]:
        return tuple(IgnoredRegion(stroke=tuple(points), radius_px=radius) for radius, points in self.strokes)


KEYS = "[  ]: Brush Size   |   Backspace: Back   |   Enter: Done   |   Esc: Cancel"
SIZES = {"LEFT_BRACKET": -1, "RIGHT_BRACKET": 1}


class KEYMARK_OT_ignore_region(MarkerTool, bpy.types.Operator):
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

    _brushed: Any = None
    """The regions that were brushed; None in a script. Blender would evaluate a type named here."""

    def prepare(self, context: Context, take: PropertyGroup) -> None:
        super().prepare(context, take)
        with reported(self):
            update_masks(context.scene)
        show_masks(context, preview_of(take) is not None)
        Brush.at_work = Brush(take.clip.size[0])

    def modal(self, context: Context, event: Event) -> set[str]:
        """Brush until Enter, then look for the markers anew; Esc takes all strokes back."""
        brush = Brush.at_work
        if self._job is not None:
            return super().modal(context, event)
        if brush is None:  # another file was opened
            return {"CANCELLED"}
        if brush.is_down and event.type == "MOUSEMOVE":
            pixel = pixel_under(context, active_take(context.scene), event.mouse_x, event.mouse_y)
            if pixel is not None:
                brush.move(pixel)
        elif event.type == "LEFTMOUSE" and event.value == "RELEASE":
            brush.is_down = False
        elif event.type in SIZES and event.value == "PRESS":
            brush.grow(SIZES[event.type])
            self.ask(context)
            return {"RUNNING_MODAL"}
        return super().modal(context, event)

    def request(self, context: Context) -> tuple[FootageRequest, str]:
        brush = Brush.at_work
        radius = 0.0 if brush is None else brush.radius_px
        detail = "as a wall or a chair of a marker's color"
        return FootageRequest("Brush over what is no marker", detail, radius), KEYS

    def clicked(self, context: Context, pixel: Pixel) -> set[str]:
        brush = Brush.at_work
        if brush is not None:
            brush.press(pixel)
            redraw_footage(context)
        return {"RUNNING_MODAL"}

    def go_back(self, context: Context) -> None:
        brush = Brush.at_work
        if brush is not None and brush.strokes:
            brush.strokes.pop()
            brush.is_down = False

    def done(self, context: Context) -> set[str]:
        brush = Brush.at_work
        if brush is None or not brush.strokes:
            return super().done(context)
        self._brushed, self.radius = brush.regions(), brush.radius_px
        self.path.clear()
        for time, (_, points) in enumerate(brush.strokes):
            for pixel in points:
                point = self.path.add()
                point.loc, point.time = pixel, time
        return self.look(context)

    def cancel(self, context: Context) -> None:
        Brush.at_work = None
        super().cancel(context)

    def start(self, scene: Scene) -> Job[MarkerSearch]:
        if self._brushed is not None:
            return search_markers(scene, more=self._brushed)
        if not len(self.path):
            raise InputError("path is empty; give at least one pixel of the footage")
        brush, stroke = Brush(active_take(scene).clip.size[0], self.radius), None
        for point in self.path:
            if point.time != stroke:
                brush.press(tuple(point.loc))
            else:
                brush.strokes[-1][1].append(tuple(point.loc))
            stroke = point.time
        return search_markers(scene, more=brush.regions())

    def finish(self, scene: Scene, result: MarkerSearch) -> None:
        write_and_warn(self, scene, result, masks=self.masks_before is not None and result.check is not None)
        self.report({"INFO"}, f"Brushed regions are never a marker: {len(result.more)} more")
