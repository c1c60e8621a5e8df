"""Over the Timeline and the Dope Sheet: how fast the markers move, where to pose, how far to believe."""

from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.app.translations import pgettext_iface
from numpy.typing import NDArray

from ...results import review_of
from ...takes import find_take
from . import drawing
from .drawing import Color, faded
from .figures import diamonds, segments
from .picture import Fill, Item, Label, Stroke, paint
from .timeline_figures import graph, in_view, joined, pointers, strip

Array = NDArray[np.float64]

MODES = ("TIMELINE", "DOPESHEET", "ACTION")
MOST_GRAPH = 70.0
"""Height of the graph where there is room [px], like the sizes that follow."""
LEAST_GRAPH = 14.0
RULER = 24.0
STRIP = 9.0
FOOT = 3.0
GAP = 4.0
DIAMOND = 5.0
POINTER = 7.0
HEADROOM = 16.0
"""Between graph and ruler, for a triangle."""
SPEED: Color = (0.35, 0.68, 0.92, 1.0)
PROPOSED: Color = (1.0, 0.82, 0.25, 1.0)
WEAK: Color = (0.95, 0.45, 0.15, 1.0)
GROUND: Color = (0.0, 0.0, 0.0, 0.28)
SAME_FRAME = 0.5
"""A key nearer than this to a proposal [frames] fills its diamond."""


@dataclass(frozen=True, eq=False)
class Timeline:
    """Where frames lie in a region, and how high things are drawn."""

    origin: float
    """Place of frame 0 [px]."""
    scale: float
    """Pixels of a frame."""
    width: float
    strip_floor: float
    floor: float
    """Of the graph."""
    height: float
    """Of the graph."""
    pixel: float
    """Pixels of the screen for one of a plain one."""

    def places(self, frames: Array) -> Array:
        """Where frames (F,) lie [px]."""
        return self.origin + self.scale * np.asarray(frames, dtype=np.float64)


def timeline_of(region: bpy.types.Region, pixel: float) -> Timeline | None:
    """How a region of the Timeline or the Dope Sheet lies; None where it is too low to draw into."""
    # Places come as whole pixels: a long way apart, the scale is exact nonetheless.
    far = 100_000.0
    start, end = (region.view2d.view_to_region(frame, 0.0, clip=False)[0] for frame in (-far, far))
    strip_floor = FOOT * pixel
    floor = strip_floor + (STRIP + GAP) * pixel
    height = min(MOST_GRAPH * pixel, region.height - floor - (RULER + HEADROOM) * pixel)
    if end <= start or height < LEAST_GRAPH * pixel:
        return None
    return Timeline(
        0.5 * (start + end), (end - start) / (2.0 * far), region.width, strip_floor, floor, height, pixel
    )


def draw(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    if context.space_data.mode not in MODES:
        return
    take = find_take(context.scene)
    timeline = timeline_of(context.region, drawing.ui_scale())
    if take is None or timeline is None:
        return
    paint(picture(context.scene, take, timeline))


def picture(scene: bpy.types.Scene, take: bpy.types.PropertyGroup, timeline: Timeline) -> list[Item]:
    """Everything that is switched on and known."""
    settings = scene.keymark.timeline
    items: list[Item] = []
    speed = _speed(scene, take)
    if settings.show_speed and speed is not None:
        items += _remembered(("speed", *speed[2], timeline), lambda: speed_graph(*speed[:2], timeline))
    review = review_of(take)
    if settings.show_confidence and review is not None and np.isfinite(review.confidence).any():
        key = ("confidence", take.review_key, timeline)
        items += _remembered(key, lambda: confidence_strip(review.frames, review.confidence, timeline))
    if settings.show_weak_frames:
        todo = [weak.frame for weak in take.review.weak_frames if not weak.is_posed]
        items += weak_pointers(np.array(todo, dtype=np.float64), timeline)
    if settings.show_proposals:
        proposed = np.array([proposal.frame for proposal in take.proposals], dtype=np.float64)
        level = np.zeros(len(proposed))
        if speed is not None and settings.show_speed:
            level = np.interp(proposed, speed[0], relative(speed[1]))
        items += proposals(proposed, level, posed(take, proposed), timeline)
    return items


def relative(speed: Array) -> Array:
    """Speeds as heights from 0 to 1: few very fast frames do not press the others down."""
    top = 1.15 * float(np.nanpercentile(speed, 98.0)) if np.isfinite(speed).any() else 1.0
    return np.clip(speed / max(top, 1e-9), 0.0, 1.0)


def speed_graph(frames: Array, speed: Array, timeline: Timeline) -> list[Item]:
    """The sum of the markers' speeds as a translucent graph."""
    x = timeline.places(frames)
    shown = in_view(x, timeline.width)
    x, values = joined(x[shown], relative(speed)[shown], lowest=False)
    if len(x) < 2:
        return []
    line, area = graph(x, values, timeline.floor, timeline.height)
    words = Label(
        pgettext_iface("Speed of markers"),
        6.0 * timeline.pixel,
        timeline.floor + timeline.height + 3.0 * timeline.pixel,
    )
    return [Fill(area, faded(SPEED, 0.28)), Stroke(segments(line), faded(SPEED, 0.9), 1.2), words]


def confidence_strip(frames: Array, confidence: Array, timeline: Timeline) -> list[Item]:
    """How far each frame can be believed, on a dark ground against which heights are read."""
    x = timeline.places(frames)
    shown = in_view(x, timeline.width)
    x, values = joined(x[shown], confidence[shown], lowest=True)
    if not len(x):
        return []
    height = STRIP * timeline.pixel
    ground, _ = strip(x[[0, -1]], np.ones(2), timeline.strip_floor, height)
    bars, colors = strip(x, values, timeline.strip_floor, height)
    return [Fill(ground, GROUND), Fill(bars, colors)]


def weak_pointers(frames: Array, timeline: Timeline) -> list[Item]:
    """Triangles over the graph that point at frames worth another keyframe, and a line down to the strip."""
    if not len(frames):
        return []
    x = timeline.places(frames)
    tip = timeline.floor + timeline.height + 1.0 * timeline.pixel
    marks = pointers(x, tip, POINTER * timeline.pixel)
    foot = np.stack([x, np.full_like(x, timeline.strip_floor)], axis=-1)
    lines = np.stack([foot, np.stack([x, np.full_like(x, tip)], axis=-1)], axis=1)
    return [
        Stroke(lines, faded(WEAK, 0.45), 1.0),
        Stroke(segments(marks, closed=True), WEAK, 1.0, 0.8),
        Fill(marks, WEAK),
    ]


def proposals(frames: Array, level: Array, done: NDArray[np.bool_], timeline: Timeline) -> list[Item]:
    """Diamonds on the graph: hollow where the actor is still to be posed, filled where it is."""
    if not len(frames):
        return []
    heights = timeline.floor + timeline.height * level
    marks = diamonds(np.stack([timeline.places(frames), heights], axis=-1), DIAMOND * timeline.pixel)
    return [
        Stroke(segments(marks, closed=True), PROPOSED, 1.6, 0.8),
        Fill(marks[done], PROPOSED),
    ]


def posed(take: bpy.types.PropertyGroup, frames: Array) -> NDArray[np.bool_]:
    """Which of the frames (N,) are keyed in the take's keyframe Action."""
    from ....core.body.human import HUMAN
    from ...bridge.keyframes import keyed_frames

    if take.armature is None or take.keyframe_action is None or not len(frames):
        return np.zeros(len(frames), dtype=bool)
    keyed = np.array(keyed_frames(take.armature, take.keyframe_action, HUMAN), dtype=np.float64)
    return np.asarray((np.abs(frames[:, None] - keyed) < SAME_FRAME).any(axis=1))


_known: dict[object, object] = {}
"""What was computed for the last few views: a redraw without a change of view only draws."""
MOST_KNOWN = 16


def _remembered(key: object, make: Callable[[], list[Item]]) -> list[Item]: ...


def _speed(
    scene: bpy.types.Scene, take: bpy.types.PropertyGroup
) -> tuple[Array, Array, tuple[object, ...]] | None: ...
