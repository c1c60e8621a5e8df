"""Tools on the footage that look for markers anew: picking the colors of all or of one, brushing away."""

from collections.abc import Generator
from dataclasses import dataclass, field
from time import monotonic
from typing import Any, ClassVar

import bpy
import numpy as np
from bpy.types import Context, Event, PropertyGroup, Scene

from ...core.errors import InputError
from ...core.markers import ignored_regions as regions_of_picture
from ...core.markers.ignored_regions import IgnoredRegion
from ...core.progress import Job
from ..bridge.footage import footage_color
from ..shell import need
from ..shell.base_operator import reported, warn
from ..shell.fields import SKIP_SAVE, Entries, Integer, Number, Pixel
from ..shell.footage_view import ClickSequence, FootageRequest, pixel_under, side_of, stop_asking
from ..shell.job_operator import SHORTEST_SLICE_S, TIMER_S, JobOperator
from ..shell.takes import active_take, footage_of, redraw_footage, take_by_identifier
from . import marker_search
from .marker_search import MarkerSearch, search_markers, write_and_warn
from .mask_previews import PICKED, learned_preview, preview_of, show_masks, update_masks
from .properties import ignored_regions, segment_title


class MarkerTool(ClickSequence, JobOperator):
    """Base of tools that take clicks, then look for the markers; `prepare` of a subclass shows the masks."""

    masks_before: bool | None = None  # Whether masks were shown before; None in a script, which shows none

    def prepare(self, context: Context, take: PropertyGroup) -> None:
        self.masks_before = bool(context.window_manager.keymark_show_masks)
        context.window_manager.keymark_progress.show("", 0.0)

    def modal(self, context: Context, event: Event) -> set[str]:
        return (ClickSequence if self._job is None else JobOperator).modal(self, context, event)

    def look(self, context: Context) -> set[str]:
        """Begin to look for the markers; what `modal` returns."""
        stop_asking(context)
        with reported(self):
            self.begin(context)
            return {"RUNNING_MODAL"}
        self.cancel(context)
        return {"CANCELLED"}

    def cancel(self, context: Context) -> None:
        stop_asking(context)
        if self.masks_before is not None:
            show_masks(context, self.masks_before)
        JobOperator.cancel(self, context)


KEYS = "{number} of {count}   |   Backspace: Back   |   Tab: Skip   |   Enter: Done   |   Esc: Cancel"


class KEYMARK_OT_pick_markers(MarkerTool, bpy.types.Operator):
    """Click on one marker after the other in the footage; without a list they are the usual five"""

    bl_label = "Pick Markers"
    requirements = (need.footage, need.idle)
    cursor = "EYEDROPPER"

    clicks: Entries(
        name="Clicks",
        description="A click a marker: its name, the pixel of the footage, and the scene frame as time",
        type=bpy.types.OperatorMousePath,
        options=SKIP_SAVE,
    )

    _wanted: Any = ()
    """Names and segments of the markers that are asked for, in order; Blender would evaluate a type."""
    _here: int = 0  # Which of them is asked for now
    _colors: Any = None
    """Picked colors by the markers' names, in the order of the clicks; None in a script. The scene stays as
    it was until all are picked: going to another frame is a step of undo."""
    _looking: Generator[Any, None, Any] | None = None
    """The search for the colors picked so far, whose masks are then shown."""

    def prepare(self, context: Context, take: PropertyGroup) -> None:
        """Ask for the markers without a color, for all where each has one, or for the usual five."""
        super().prepare(context, take)
        markers = [marker for marker in take.markers if not marker.is_picked] or list(take.markers)
        usual = [(segment, segment) for segment in marker_search.USUAL_SEGMENTS]
        self._wanted = [(marker.name, marker.segment) for marker in markers] or usual
        self._here, self._colors = 0, {}
        self._timer = context.window_manager.event_timer_add(TIMER_S, window=context.window)

    def modal(self, context: Context, event: Event) -> set[str]:
        if self._job is not None or event.type != "TIMER":
            return super().modal(context, event)
        until = monotonic() + SHORTEST_SLICE_S
        with reported(self):
            try:
                while self._looking is not None and monotonic() < until:
                    next(self._looking)
                return {"PASS_THROUGH"}
            except StopIteration:
                update_masks(context.scene)
                show_masks(context, True)
        self._looking = None
        return {"PASS_THROUGH"}

    def request(self, context: Context) -> tuple[FootageRequest, str]:
        keys = KEYS.format(number=len(self._colors) + 1, count=len(self._wanted))
        segment = self._wanted[self._here][1]
        return FootageRequest(f"Click on: {segment_title(segment)}", side_of(segment)), keys

    def clicked(self, context: Context, pixel: tuple[float, float]) -> set[str]:
        name = self._wanted[self._here][0]
        with reported(self):
            color = footage_color(footage_of(context.scene, active_take(context.scene)), pixel)
            self._colors[name] = color
            click = self.clicks.add()
            click.name, click.loc, click.time = name, pixel, context.scene.frame_current
            if len(self._colors) == len(self._wanted):
                return self.done(context)
            self._begin_to_look(context)
            self.go_on(context)
        self.ask(context)
        return {"RUNNING_MODAL"}

    def go_on(self, context: Context) -> None:
        count = len(self._wanted)
        after = [(self._here + step) % count for step in range(1, count + 1)]
        self._here = next((one for one in after if self._wanted[one][0] not in self._colors), self._here)

    def go_back(self, context: Context) -> None:
        if not self._colors:
            return
        last, _ = self._colors.popitem()
        self.clicks.remove(len(self.clicks) - 1)
        self._here = [name for name, _ in self._wanted].index(last)
        if self._colors:
            self._begin_to_look(context)
        else:
            self._stop_looking()
            show_masks(context, False)

    def done(self, context: Context) -> set[str]:
        """Look for all markers with a color; without a click nothing has happened."""
        if not self._colors:
            return super().done(context)
        self._stop_looking()
        context.window_manager.event_timer_remove(self._timer)
        self._timer = None
        return self.look(context)

    def cancel(self, context: Context) -> None:
        self._stop_looking()
        PICKED.clear()
        super().cancel(context)

    def start(self, scene: Scene) -> Job[MarkerSearch]:
        source, colors = footage_of(scene, active_take(scene)), self._colors
        if colors is None:
            colors = {one.name: footage_color(source, one.loc, round(one.time)) for one in self.clicks}
        if not colors:
            raise InputError("clicks is empty; click on at least one marker")
        return (yield from search_markers(scene, colors))

    def finish(self, scene: Scene, result: MarkerSearch) -> None:
        write_and_warn(self, scene, result, masks=self._colors is not None)
        self.report({"INFO"}, f"{len(result.colors)} markers are picked")

    def _begin_to_look(self, context: Context) -> None:
        self._stop_looking()
        take = active_take(context.scene)
        styles = marker_search.styles_with_colors(take, self._colors)
        search = marker_search.find_markers(footage_of(context.scene, take), styles, ignored_regions(take))

        identifier = take.identifier

        def look() -> Job[None]:
            PICKED[identifier] = learned_preview(styles, (yield from search))

        self._looking = look()

    def _stop_looking(self) -> None:
        if self._looking is not None:
            self._looking.close()
            self._looking = None


class KEYMARK_OT_pick_marker_color(MarkerTool, bpy.types.Operator):
    """Click on this one marker in the footage, to take its color from there and look for it in the clip"""

    bl_label = "Pick Marker Color"
    requirements = (need.footage, need.markers, need.idle)
    cursor = "EYEDROPPER"
    ends_beside = False

    pixel: Pixel("Pixel", "Where to pick")
    row: Integer("Row", "Row of the marker, from 0; -1 for the active one", default=-1, options=SKIP_SAVE)

    def prepare(self, context: Context, take: PropertyGroup) -> None:
        super().prepare(context, take)
        show_masks(context, False)  # the footage itself is what is clicked on

    def request(self, context: Context) -> tuple[FootageRequest, str]:
        segment = self._marker(active_take(context.scene)).segment
        return FootageRequest(f"Click on: {segment_title(segment)}", side_of(segment)), "Esc: Cancel"

    def clicked(self, context: Context, pixel: tuple[float, float]) -> set[str]:
        self.pixel = pixel
        return self.look(context)

    def start(self, scene: Scene) -> Job[MarkerSearch]:
        """The color is read from the clip's file: the viewport's has gone through color management."""
        take = active_take(scene)
        name, color = self._marker(take).name, footage_color(footage_of(scene, take), self.pixel)
        return (yield from search_markers(scene, {name: color}))

    def finish(self, scene: Scene, result: MarkerSearch) -> None:
        marker_search.write_search(scene, result, masks=self.masks_before is not None)
        ((name, color),) = result.colors.items()
        marker = next(each for each in take_by_identifier(scene, result.take).markers if each.name == name)
        for sentence in marker.warning.splitlines():
            warn(self, sentence)
        found = f"found in {marker.found} of {marker.sampled} frames"
        self.report({"INFO"}, f"Marker {name} has the color {color}, {found}")

    def _marker(self, take: PropertyGroup) -> PropertyGroup:
        row = int(take.active_marker) if self.row < 0 else self.row
        return take.markers[min(row, len(take.markers) - 1)]


Place = tuple[float, float]


@dataclass
class Brush:
    """A brush that draws strokes."""

    at_work: "ClassVar[Brush | None]" = None
    width: int  # Width of the footage in px
    radius_px: float = 0.0  # Its radius in pixels of the footage; 0 for the usual one
    strokes: list[tuple[float, list[Place]]] = field(default_factory=list)
    """Radius and points of each stroke."""
    is_down: bool = False

    def __post_init__(self) -> None:
        self.radius_px = self.radius_px or max(0.03 * self.width, 1.0)

    def press(self, pixel: Place) -> None:
        self.strokes.append((self.radius_px, [pixel]))
        self.is_down = True

    def move(self, pixel: Place) -> None:
        """Go on with the stroke; a long one goes on as another."""
        radius, points = self.strokes[-1]
        if np.hypot(pixel[0] - points[-1][0], pixel[1] - points[-1][1]) < 0.25 * radius:
            return  # nearer points would not be seen
        if len(points) >= regions_of_picture.MOST_POINTS:
            self.strokes.append((radius, [points[-1]]))
        self.strokes[-1][1].append(pixel)

    def grow(self, steps: int) -> None:
        """Make it larger, or smaller with fewer than no steps."""
        self.radius_px = float(np.clip(self.radius_px * 1.25**steps, 1.0, 0.5 * self.width))

    def regions(self) -> tuple[IgnoredRegion, ...]:
        return tuple(IgnoredRegion(stroke=tuple(points), radius_px=radius) for radius, points in self.strokes)


BRUSH_KEYS = "[  ]: Brush Size   |   Backspace: Back   |   Enter: Done   |   Esc: Cancel"
SIZES = {"LEFT_BRACKET": -1, "RIGHT_BRACKET": 1}


class KEYMARK_OT_ignore_region(MarkerTool, bpy.types.Operator):
    """Brush over what has a marker's color and is none, as a wall or a chair; it is never taken for one"""

    bl_label = "Not This"
    requirements = (need.footage, need.markers, need.idle)
    cursor = "PAINT_CROSS"
    ends_beside = False

    path: Entries(
        name="Path",
        description="Pixels of the footage under the brush; a new stroke begins with another time",
        type=bpy.types.OperatorMousePath,
        options=SKIP_SAVE,
    )
    radius: Number("Radius", "Radius of the brush in the footage", default=10.0, min=0.5, options=SKIP_SAVE)

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
        return FootageRequest("Brush over what is no marker", detail, radius), BRUSH_KEYS

    def clicked(self, context: Context, pixel: Place) -> set[str]:
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
