"""Overlay of Timeline and Dope Sheet: speed, confidence, proposed and found keyframes, weak frames."""

from dataclasses import dataclass

import numpy as np
from bpy.types import Context, PropertyGroup, Scene

from ...core.arrays import Array
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


def in_view(x: Array, values: Array, width: float, pick: np.ufunc) -> tuple[Array, Array]:
    """Frames at rising positions (F,) in a region, with values; of those too near, the one to `pick`."""
    first, last = np.searchsorted(x, (0.0, width))
    x, values = (each[max(0, int(first) - 1) : int(last) + 1] for each in (x, values))
    if len(x) < 2 or x[-1] - x[0] >= FINEST_PX * (len(x) - 1):
        return x, values
    column = np.floor((x - x[0]) / FINEST_PX).astype(np.intp)
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    return x[starts], pick.reduceat(values, starts)


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
    def floor(self) -> float:
        """Bottom of the graph [px]."""
        return (self.sizes.foot + self.sizes.strip + self.sizes.gap) * self.pixel

    def frame_x(self, frames: Array) -> Array:
        """Horizontal positions (F,) of frames [px]."""
        return self.origin + self.scale * np.asarray(frames, dtype=np.float64)

    def fitting(self, x: Array, size: float) -> float:
        """A mark's size [px], smaller where marks at x (N,) would cover each other."""
        apart = float(np.median(np.diff(np.sort(x)))) if len(x) > 2 else np.inf
        return float(np.clip(0.6 * apart, 0.4 * size * self.pixel, size * self.pixel))


def draw(context: Context) -> list[Item]:
    """What a take has to show in Timeline and Dope Sheet; nothing where the region is too low."""
    take, region, pixel = find_take(context.scene), context.region, ui_scale()
    shown = context.space_data.mode in MODES and context.scene.keymark.overlays.show_timeline
    if take is None or not shown:
        return []
    # Positions are whole pixels: far apart, they still give an exact scale.
    far = 100_000.0
    start, end = (region.view2d.view_to_region(frame, 0.0, clip=False)[0] for frame in (-far, far))
    for sizes in (ROOMY, SLIM):
        taken = sizes.foot + sizes.strip + sizes.gap + sizes.headroom + sizes.ruler
        height = min(sizes.graph, region.height / pixel - taken)
        if height >= sizes.least and end > start:
            middle, scale = 0.5 * (start + end), (end - start) / (2.0 * far)
            timeline = Timeline(middle, scale, region.width, height * pixel, pixel, sizes)
            return picture(context.scene, take, timeline)
    return []


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
            x, level = timeline.frame_x(frames), np.zeros(len(frames))
            if speed is not None:
                level = np.interp(frames, speed.frames, relative(speed.values))
            centers = np.stack([x, timeline.floor + timeline.height * level], axis=-1)
            figures = shape(centers, timeline.fitting(x, timeline.sizes.diamond))
            items += [Stroke(segments(figures, closed=True), color, 1.6, 0.8), Fill(figures[filled], color)]
    return items


def relative(speed: Array) -> Array:
    """Speeds as heights from 0 to 1; a few very fast frames are clipped."""
    top = 1.15 * float(np.nanpercentile(speed, 98.0)) if np.isfinite(speed).any() else 1.0
    return np.clip(speed / max(top, 1e-9), 0.0, 1.0)


def speed_graph(frames: Array, speed: Array, timeline: Timeline) -> list[Item]:
    """The sum of the speeds of what is followed as a translucent graph; NaN leaves a gap."""
    x, values = in_view(timeline.frame_x(frames), relative(speed), timeline.width, np.fmax)
    if len(x) < 2:
        return []
    floor, top = timeline.floor, timeline.floor + timeline.height * values
    area = polygons((x[:-1], floor), (x[1:], floor), (x[1:], top[1:]), (x[:-1], top[:-1]))
    line = segments(np.stack([x, top], axis=-1))
    items: list[Item] = [Fill(area, faded(SPEED, 0.28)), Stroke(line, faded(SPEED, 0.9), 1.2)]
    if timeline.sizes == ROOMY:
        y = floor + timeline.height - 13.0 * timeline.pixel
        items.append(Label("Speed in the footage", 6.0 * timeline.pixel, y))
    return items


def confidence_strip(frames: Array, confidence: Array, timeline: Timeline) -> list[Item]:
    """A bar a frame on a dark ground, the higher and bluer, the more confident; NaN leaves a gap."""
    x, values = in_view(timeline.frame_x(frames), confidence, timeline.width, np.fmin)
    if not len(x):
        return []
    floor, height = timeline.sizes.foot * timeline.pixel, timeline.sizes.strip * timeline.pixel
    reach = 0.5 * (x[1] - x[0]) if len(x) > 1 else 2.0
    edges = np.concatenate([[x[0] - reach], 0.5 * (x[1:] + x[:-1]), [x[-1] + reach]])
    left, right, top = edges[:-1], edges[1:], floor + height * values
    bottom = np.where(np.isfinite(top), floor, np.nan)
    bars = polygons((left, bottom), (right, bottom), (right, top), (left, top))
    share = np.nan_to_num(np.clip((values - DOUBTFUL) / (1.0 - DOUBTFUL), 0.0, 1.0))
    levels = [np.interp(share, (0.0, 0.5, 1.0), column) for column in CONFIDENCE_COLORS.T]
    (first, last), high = edges[[0, -1]], floor + height
    ground = np.array([[(first, floor), (last, floor), (last, high), (first, high)]])
    return [Fill(ground, GROUND), Fill(bars, np.column_stack([*levels, np.ones(len(x))]))]


def weak_pointers(frames: Array, timeline: Timeline) -> list[Item]:
    """Triangles over the graph that point at frames worth another keyframe, and a line down to the strip."""
    if not len(frames):
        return []
    x, tip = timeline.frame_x(frames), timeline.floor + timeline.height + timeline.pixel
    size = timeline.fitting(x, timeline.sizes.pointer)
    marks = polygons((x, tip), (x + 0.6 * size, tip + size), (x - 0.6 * size, tip + size))
    return [
        Stroke(polygons((x, timeline.sizes.foot * timeline.pixel), (x, tip)), faded(WEAK, 0.45), 1.0),
        Stroke(segments(marks, closed=True), WEAK, 1.0, 0.8),
        Fill(marks, WEAK),
    ]


_speeds: LruCache[FootageSpeed] = LruCache()
_views: LruCache[list[Item]] = LruCache(16)


def _speed(scene: Scene, take: PropertyGroup) -> FootageSpeed | None:
    """The speed that keyframes were proposed by; else of the motion's review, or of markers as read."""
    reading, review, proposed = reading_of(take), review_of(take), speed_of(take)
    if proposed is not None:
        return proposed
    marked = reading is not None and reading.tracks.visible.any() and take.clip is not None
    if review is not None and (not marked or review.keypoints.names):
        return FootageSpeed(take.review_key, review.frames, review.speed)
    if reading is None or not marked:
        return None
    from ...core.prior.keyframe_proposals import marker_speed  # late: Keymark registers without SciPy

    footage, tracks = footage_of(scene, take), reading.tracks
    key = f"{take.reading_key} {footage.first_frame} {footage.rate}"
    frames = scene_frames(tracks.time_s, footage.first_frame, footage.rate)
    return _speeds.known(key, lambda: FootageSpeed(key, frames, marker_speed(tracks)))
