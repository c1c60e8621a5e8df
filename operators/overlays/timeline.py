"""Overlay of Timeline and Dope Sheet: speed, confidence, proposed and found keyframes, weak frames."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from bpy.types import Context, PropertyGroup, Region, Scene

from ...core.arrays import Array, BoolArray
from ..bridge.scene_frames import scene_frames
from ..shell.keyed_frames import have_frames
from ..shell.results import FootageSpeed, LruCache, reading_of, review_of, speed_of
from ..shell.take_state import DOUBTFUL, TakeState
from ..shell.takes import find_take, footage_of
from .drawing import Color, Fill, Item, Label, Stroke, faded, ui_scale
from .figures import diamonds, polygons, segments, squares

CONFIDENCE_COLORS = np.array([[0.90, 0.42, 0.10], [0.93, 0.83, 0.35], [0.22, 0.55, 0.90]])
"""Of low, middle and high confidence, also for color-blind eyes."""
FINEST_PX = 1.5  # frames nearer than this are drawn as one


def joined(x: Array, values: Array, *, lowest: bool) -> tuple[Array, Array]:
    """Merge frames at rising positions (F,) too close to tell apart; their lowest or highest value is kept.

    A long clip then takes no longer to draw.
    """
    if len(x) < 2 or x[-1] - x[0] >= FINEST_PX * (len(x) - 1):
        return x, values
    column = np.floor((x - x[0]) / FINEST_PX).astype(np.intp)
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    pick = np.fmin if lowest else np.fmax
    return x[starts], pick.reduceat(values, starts)


def in_view(x: Array, width: float) -> slice:
    """The frames at increasing positions (F,) that a region of this width shows, and one on each side."""
    first, last = np.searchsorted(x, (0.0, width))
    return slice(max(0, int(first) - 1), int(last) + 1)


def graph(x: Array, values: Array, floor: float, height: float) -> tuple[Array, Array]:
    """A curve (N, 2) of values 0 to 1 at positions (N,), and the pieces (N - 1, 4, 2) of the area under it.

    NaN leaves a gap; `floor` is the height of 0, `height` the distance from 0 to 1.
    """
    top = floor + height * values
    area = polygons((x[:-1], floor), (x[1:], floor), (x[1:], top[1:]), (x[:-1], top[:-1]))
    return np.stack([x, top], axis=-1), area


def strip(x: Array, confidence: Array, floor: float, height: float) -> tuple[Array, Array]:
    """A bar (N, 4, 2) and its opaque color (N, 4) a frame: the higher and bluer, the higher its confidence.

    NaN leaves a gap; `height` is that of a bar of confidence 1.
    """
    middles = 0.5 * (x[1:] + x[:-1])
    reach = 0.5 * (x[1] - x[0]) if len(x) > 1 else 2.0
    left = np.concatenate([[x[0] - reach], middles])
    right = np.concatenate([middles, [x[-1] + reach]])
    top = floor + height * confidence
    bottom = np.where(np.isfinite(top), floor, np.nan)
    bars = polygons((left, bottom), (right, bottom), (right, top), (left, top))
    return bars, np.column_stack([confidence_color(confidence), np.ones(len(x))])


def confidence_color(confidence: Array) -> Array:
    """Colors (N, 3) of confidences (N,)."""
    share = np.nan_to_num(np.clip((confidence - DOUBTFUL) / (1.0 - DOUBTFUL), 0.0, 1.0))
    return np.stack([np.interp(share, (0.0, 0.5, 1.0), column) for column in CONFIDENCE_COLORS.T], axis=-1)


def pointers(x: Array, tip: float, size: float) -> Array:
    """(N, 3, 2) triangles that point down to a height at positions (N,)."""
    half, top = 0.6 * size, tip + size
    return polygons((x, tip), (x + half, top), (x - half, top))


MODES = ("TIMELINE", "DOPESHEET", "ACTION")


@dataclass(frozen=True)
class Sizes:
    """Unscaled sizes [px]."""

    graph: float  # largest height of the graph
    least: float  # smallest height of the graph
    ruler: float  # height kept free at the top
    headroom: float  # height between graph and ruler, for triangles and text
    strip: float
    foot: float  # height below the strip, for Blender's scroll bar
    gap: float  # height between strip and graph
    diamond: float
    pointer: float


ROOMY = Sizes(80.0, 16.0, ruler=24.0, headroom=18.0, strip=11.0, foot=13.0, gap=3.0, diamond=5.0, pointer=8.0)
SLIM = Sizes(40.0, 6.0, ruler=0.0, headroom=6.0, strip=5.0, foot=1.0, gap=1.0, diamond=4.0, pointer=5.0)
"""Sizes for a Timeline as low as its ruler, as Blender 5 opens it."""
SPEED: Color = (0.35, 0.68, 0.92, 1.0)
PROPOSED: Color = (1.0, 0.82, 0.25, 1.0)
MATCHED: Color = (0.55, 0.88, 0.60, 1.0)
WEAK: Color = (0.95, 0.45, 0.15, 1.0)
GROUND: Color = (0.0, 0.0, 0.0, 0.28)


@dataclass(frozen=True)
class Timeline:
    """Horizontal positions of frames in a region, and heights of graph and strip."""

    origin: float  # horizontal position of frame 0 [px]
    scale: float  # pixels for each frame
    width: float
    height: float  # height of the graph [px]
    pixel: float  # screen pixels for each unscaled pixel
    sizes: Sizes

    @property
    def strip_floor(self) -> float:
        """Bottom of the strip [px]."""
        return self.sizes.foot * self.pixel

    @property
    def floor(self) -> float:
        """Bottom of the graph [px]."""
        return (self.sizes.foot + self.sizes.strip + self.sizes.gap) * self.pixel

    @property
    def top(self) -> float:
        """Top of the graph [px]."""
        return self.floor + self.height

    def frame_x(self, frames: Array) -> Array:
        """Horizontal positions (F,) of frames [px]."""
        return self.origin + self.scale * np.asarray(frames, dtype=np.float64)

    def fitting(self, x: Array, size: float) -> float:
        """A mark's size [px], smaller where marks at x (N,) would cover each other."""
        apart = float(np.median(np.diff(np.sort(x)))) if len(x) > 2 else np.inf
        return float(np.clip(0.6 * apart, 0.4 * size * self.pixel, size * self.pixel))


def timeline_of(region: Region, pixel: float) -> Timeline | None:
    """The layout of a region of Timeline or Dope Sheet; None where it is too low to draw into."""
    # Positions are whole pixels: far apart, they still give an exact scale.
    far = 100_000.0
    start, end = (region.view2d.view_to_region(frame, 0.0, clip=False)[0] for frame in (-far, far))
    for sizes in (ROOMY, SLIM):
        taken = sizes.foot + sizes.strip + sizes.gap + sizes.headroom + sizes.ruler
        height = min(sizes.graph, region.height / pixel - taken)
        if height >= sizes.least and end > start:
            middle, scale = 0.5 * (start + end), (end - start) / (2.0 * far)
            return Timeline(middle, scale, region.width, height * pixel, pixel, sizes)
    return None


def draw(context: Context) -> list[Item]:
    """What a take has to show in Timeline and Dope Sheet."""
    take, timeline = find_take(context.scene), None
    if context.space_data.mode in MODES and context.scene.keymark.overlays.show_timeline:
        timeline = timeline_of(context.region, ui_scale())
    return [] if take is None or timeline is None else picture(context.scene, take, timeline)


def picture(scene: Scene, take: PropertyGroup, timeline: Timeline) -> list[Item]:
    """All items that have data; graph and strip are kept, so that a redraw of the same view only draws."""
    items: list[Item] = []
    state = TakeState(take)
    speed, review = _speed(scene, take), review_of(take)
    if speed is not None:
        key = f"speed {speed.key} {timeline}"
        items += _views.known(key, lambda: speed_graph(speed.frames, speed.values, timeline)) or []
    if review is not None and np.isfinite(review.confidence).any():
        key = f"confidence {take.review_key} {timeline}"
        items += _views.known(key, lambda: confidence_strip(review.frames, review.confidence, timeline)) or []
    weak = np.array([weak.frame for weak in take.review.weak_frames], dtype=np.float64)
    proposed = np.array([proposal.frame for proposal in take.proposals], dtype=np.float64)
    posed = state.posed if len(weak) or len(proposed) else ()
    found = state.matched
    items += weak_pointers(weak[~have_frames(posed, weak)], timeline)
    still, matched = proposed[~have_frames(found, proposed)], np.array(found)
    doubtful = [round(take.matching.matches[place].frame, 3) for place in state.doubtful]
    for shape, frames, filled, color in (
        (diamonds, still, have_frames(posed, still), PROPOSED),
        (squares, matched, ~np.isin(matched, doubtful), MATCHED),
    ):
        if len(frames):
            graph = None if speed is None else (speed.frames, relative(speed.values))
            level = np.zeros(len(frames)) if graph is None else np.interp(frames, *graph)
            items += marks(shape, frames, level, filled, color, timeline)
    return items


def relative(speed: Array) -> Array:
    """Speeds as heights from 0 to 1; a few very fast frames are clipped."""
    top = 1.15 * float(np.nanpercentile(speed, 98.0)) if np.isfinite(speed).any() else 1.0
    return np.clip(speed / max(top, 1e-9), 0.0, 1.0)


def speed_graph(frames: Array, speed: Array, timeline: Timeline) -> list[Item]:
    """The sum of the speeds of what is followed as a translucent graph."""
    x = timeline.frame_x(frames)
    shown = in_view(x, timeline.width)
    x, values = joined(x[shown], relative(speed)[shown], lowest=False)
    if len(x) < 2:
        return []
    line, area = graph(x, values, timeline.floor, timeline.height)
    items: list[Item] = [Fill(area, faded(SPEED, 0.28)), Stroke(segments(line), faded(SPEED, 0.9), 1.2)]
    if timeline.sizes == ROOMY:
        words = "Speed in the footage"
        items.append(Label(words, 6.0 * timeline.pixel, timeline.top - 13.0 * timeline.pixel))
    return items


def confidence_strip(frames: Array, confidence: Array, timeline: Timeline) -> list[Item]:
    """Confidence of each frame as bars, on a dark background against which heights are read."""
    x = timeline.frame_x(frames)
    shown = in_view(x, timeline.width)
    x, values = joined(x[shown], confidence[shown], lowest=True)
    if not len(x):
        return []
    floor, height = timeline.strip_floor, timeline.sizes.strip * timeline.pixel
    bars, colors = strip(x, values, floor, height)
    (left, right), top = bars[[0, -1], [0, 1], 0], floor + height
    ground = np.array([[(left, floor), (right, floor), (right, top), (left, top)]])
    return [Fill(ground, GROUND), Fill(bars, colors)]


def weak_pointers(frames: Array, timeline: Timeline) -> list[Item]:
    """Triangles over the graph that point at frames worth another keyframe, and a line down to the strip."""
    if not len(frames):
        return []
    x = timeline.frame_x(frames)
    tip = timeline.top + timeline.pixel
    marks = pointers(x, tip, timeline.fitting(x, timeline.sizes.pointer))
    return [
        Stroke(polygons((x, timeline.strip_floor), (x, tip)), faded(WEAK, 0.45), 1.0),
        Stroke(segments(marks, closed=True), WEAK, 1.0, 0.8),
        Fill(marks, WEAK),
    ]


def marks(
    shape: Callable[[Array, float], Array],
    frames: Array,
    level: Array,
    filled: BoolArray,
    color: Color,
    timeline: Timeline,
) -> list[Item]:
    """Diamonds or squares at frames (K,) of the graph, at heights (K,) from 0 to 1; some filled."""
    x = timeline.frame_x(frames)
    centers = np.stack([x, timeline.floor + timeline.height * level], axis=-1)
    figures = shape(centers, timeline.fitting(x, timeline.sizes.diamond))
    return [Stroke(segments(figures, closed=True), color, 1.6, 0.8), Fill(figures[filled], color)]


_speeds: LruCache[FootageSpeed] = LruCache()
_views: LruCache[list[Item]] = LruCache(16)


def _speed(scene: Scene, take: PropertyGroup) -> FootageSpeed | None:
    """The speed in the footage that keyframes were proposed by; else of the motion's review or the reading.

    The reading tells of markers alone.
    """
    reading, review, proposed = reading_of(take), review_of(take), speed_of(take)
    if proposed is not None:
        return proposed
    marked = reading is not None and reading.tracks.visible.any() and take.clip is not None
    if review is not None and (not marked or review.keypoints.names):
        return FootageSpeed(take.review_key, review.frames, review.speed)
    if reading is None or not marked:
        return None
    footage, tracks = footage_of(scene, take), reading.tracks
    key = f"{take.reading_key} {footage.first_frame} {footage.rate}"

    def read() -> FootageSpeed:
        from ...core.prior.keyframe_proposals import marker_speed  # late: Keymark registers without SciPy

        frames = scene_frames(tracks.time_s, footage.first_frame, footage.rate)
        return FootageSpeed(key, frames, marker_speed(tracks))

    return _speeds.known(key, read)
