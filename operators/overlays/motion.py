"""Overlay of the reconstructed motion: body, markers, keypoints, paths, and their legend.

A keypoint is a cross where it is seen, a ring where the motion puts it; shapes tell apart what colors do: one
that is not believed is a slanting cross, one that its source saw on the other side of the body a cross in a
square.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from bpy.types import Context, PropertyGroup, Scene

from ...core.arrays import Array, BoolArray, IndexArray
from ...core.detect.keypoints import mirrored_point
from ...core.review.weak_frames import TURNED
from ..bridge.actor_bones import joint_places
from ..follow.evidence import FrameKeypoints, keypoints_at
from ..shell.footage_view import FootageView, footage_view
from ..shell.results import review_of
from ..shell.take_state import TakeState
from ..shell.takes import find_take
from . import drawing
from .drawing import Fill, Item, Label, Stroke, Style, body_scale, side_color, ui_scale
from .figures import SLANTING, UPRIGHT, circles, dashes, diamonds, limb_lines, segments, squares
from .legend import SOURCE_SAMPLES, Row, Sample, corner, legend
from .views import MotionView, motion_view

if TYPE_CHECKING:
    from ...core.review.compared_keypoints import ComparedKeypoints
    from ...core.review.review import Review


ToRegion = Callable[[Array], Array]
ARM, RING = 5.5, 3.5  # half-length of a cross's arms, and radius of a ring [px]


def window(index: int, frame_count: int) -> IndexArray:
    """Indices of a path's frames about one, within the clip."""
    return np.arange(max(0, index - drawing.PATH_FRAMES), min(frame_count, index + drawing.PATH_FRAMES + 1))


def paths(
    names: Sequence[str],
    positions: Array,
    frames: IndexArray,
    index: int,
    keyframe_indices: IndexArray,
    style: Style,
) -> list[Item]:
    """The paths of N points: `positions` (N, I, 2) at the clip's `frames` (I,), about the frame `index`."""
    keyed = np.isin(frames, keyframe_indices)
    dots, marks = positions[:, ~keyed].reshape(-1, 2), positions[:, keyed]
    items: list[Item] = []
    for name, path in zip(names, positions, strict=True):
        color = style.color(side_color(name))
        ahead = dashes(path[frames >= index], style.dash * style.scale, style.gap * style.scale)
        items.append(Stroke(segments(path[frames <= index]), color, style.width, style.halo))
        items.append(Stroke(ahead, color, style.width, style.halo))
    items.append(Fill(circles(dots, style.size(style.dot + style.width / 2), 8), style.color(drawing.MIDDLE)))
    # All edges, then all diamonds: alike neighbors are drawn in one call.
    corners = [diamonds(mark, style.size(style.diamond)) for mark in marks]
    colors = [style.color(side_color(name)) for name in names]
    pairs = list(zip(corners, colors, strict=True))
    items += [Stroke(segments(mark, closed=True), color, 1.5, style.halo) for mark, color in pairs]
    items += [Fill(mark, color) for mark, color in pairs]
    return items


def source_color(sources: Sequence[str], source: str, style: Style) -> tuple[float, ...]:
    """The color of a source among all that are drawn; the fifth has the first's again."""
    return style.color(drawing.SOURCES[list(dict.fromkeys(sources)).index(source) % len(drawing.SOURCES)])


def all_sources(keypoints: "ComparedKeypoints | None", seen: Sequence[FrameKeypoints]) -> tuple[str, ...]:
    """The sources of what is drawn, those of the motion's keypoints first."""
    compared = () if keypoints is None else keypoints.sources
    return tuple(dict.fromkeys((*compared, *(each.source for each in seen))))


def compared_marks(
    keypoints: "ComparedKeypoints", index: int, to_region: ToRegion, sources: Sequence[str], style: Style
) -> list[Item]:
    """The keypoints of one frame that a motion was held against; `sources` in order of color."""
    if not keypoints.names:
        return []
    seen, predicted = to_region(keypoints.seen[index]), to_region(keypoints.predicted[index])
    colors = np.array([source_color(sources, source, style) for source in keypoints.sources])
    thrown_out, swapped = keypoints.thrown_out[index], keypoints.swapped[index]
    red = np.broadcast_to(style.color(drawing.THROWN_OUT), colors.shape)
    links = np.stack([seen, predicted], axis=1)
    linked = np.isfinite(links).all(axis=(-2, -1)) & ~thrown_out
    shown = np.isfinite(seen).all(axis=-1)
    rims = circles(predicted, style.size(RING), 12)
    ringed = np.isfinite(predicted).all(axis=-1)
    frames = squares(seen, style.size(1.1 * ARM))
    return [
        Stroke(links[linked], colors[linked], style.width),
        _outlines(rims, ringed, colors, style),
        _crosses(seen, shown & ~thrown_out, colors, UPRIGHT, style),
        _crosses(seen, shown & thrown_out, red, SLANTING, style),
        _outlines(frames, shown & swapped, colors, style),
    ]


def seen_marks(
    seen: Sequence[FrameKeypoints], to_region: ToRegion, sources: Sequence[str], style: Style
) -> list[Item]:
    """The keypoints that a take's sources see in a frame, of everyone; `sources` in order of color."""
    items: list[Item] = []
    for each in seen:
        places = to_region(each.pixel.reshape(-1, 2))
        color = np.array(source_color(sources, each.source, style))
        known = np.isfinite(places).all(axis=-1)
        items.append(_crosses(places, known, np.broadcast_to(color, (len(places), 4)), UPRIGHT, style))
    return items


def not_yet_compared(
    seen: Sequence[FrameKeypoints], keypoints: "ComparedKeypoints", index: int
) -> tuple[FrameKeypoints, ...]:
    """What of a frame's keypoints the motion was not held against: clicked since, or other people's."""
    found = []
    for each in seen:
        pixel = each.pixel.copy()
        for column, name in enumerate(each.names):
            sides = name, mirrored_point(name)
            same = [point for point, known in enumerate(keypoints.names) if known in sides]
            apart = np.linalg.norm(pixel[:, column, None] - keypoints.seen[index, same], axis=-1)
            pixel[(apart < 0.5).any(axis=1), column] = np.nan
        if np.isfinite(pixel).any():
            found.append(replace(each, pixel=pixel))
    return tuple(found)


def _crosses(places: Array, shown: BoolArray, colors: Array, directions: Array, style: Style) -> Stroke:
    arms = style.size(ARM) * directions
    lines = places[shown][:, None, None] + np.stack([-arms, arms], axis=1)  # (N, 2, 2, 2)
    return Stroke(lines.reshape(-1, 2, 2), np.repeat(colors[shown], 2, axis=0), style.width, style.halo)


def _outlines(corners: Array, shown: BoolArray, colors: Array, style: Style) -> Stroke:
    count = corners.shape[1]
    lines = segments(corners[shown], closed=True)
    return Stroke(lines, np.repeat(colors[shown], count, axis=0), style.width, style.halo)


def skeleton(
    review: "Review", index: int, positions: Array, pixels_per_meter: Array, style: Style
) -> list[Item]:
    """The body of one frame: its points (13, 2) in region pixels, and the size (13,) of a meter at each."""
    names, sigma = review.point_names, review.sigma_m[index]
    uncertain, seen = sigma > drawing.UNCERTAIN_M, np.isfinite(positions).all(axis=-1)
    colors = np.array([style.color(side_color(name)) for name in names])
    lines, sides = limb_lines(names, positions)
    limb_colors = np.array([style.color(drawing.SIDES[side]) for side in sides.tolist()]).reshape(-1, 4)
    width = style.limb * style.width * style.body_scale
    rims = circles(positions, style.size(style.joint), 16)
    radii = sigma * pixels_per_meter
    vague = uncertain & seen & np.isfinite(radii)
    around = segments(circles(positions[vague], radii[vague], 48), closed=True)[::2]
    return [
        Stroke(lines, limb_colors, width, style.halo),
        Stroke(lines[sides == "R"], style.color(drawing.CORE), style.core * width),
        Stroke(segments(rims[seen], closed=True), np.repeat(colors[seen], 16, axis=0), 1.5, style.halo),
        Fill(rims[seen & ~uncertain], colors[seen & ~uncertain]),
        Stroke(around, np.repeat(colors[vague], 24, axis=0), 1.0, style.halo),
    ]


@dataclass(frozen=True, eq=False)
class Shown:
    """A frame of a take's motion that is drawn."""

    take: PropertyGroup
    review: "Review"
    index: int  # index in the clip of the scene's current frame

    @property
    def hidden(self) -> list[int]:
        """Indices of the markers that were not found."""
        seen = np.isfinite(self.review.observed[self.index]).all(axis=-1).any(axis=-1)
        return np.flatnonzero(~seen).tolist()

    @property
    def colors(self) -> list[tuple[float, float, float]]:
        chosen = {marker.name: tuple(marker.color) for marker in self.take.markers}
        return [chosen.get(name, (0.8, 0.8, 0.8)) for name in self.review.marker_names]


Part = tuple[list[Item], list[Row]]


def _paths(what: Shown, view: MotionView, style: Style) -> Part:
    review = what.review
    frames = window(what.index, len(review.frames))
    chosen = [point for point, name in enumerate(review.point_names) if name in drawing.PATH_POINTS]
    names = [review.point_names[point] for point in chosen]
    positions = np.swapaxes(view.point_positions(review, frames)[:, chosen], 0, 1)
    rows = [(Sample.PAST, "Path so far"), (Sample.FUTURE, "Path to come"), (Sample.DIAMOND, "Keyframe")]
    return paths(names, positions, frames, what.index, review.keyframe_indices, style), rows


def _observed(what: Shown, view: MotionView, style: Style) -> Part:
    assert view.footage is not None
    hidden = [what.review.marker_names[marker] for marker in what.hidden]
    rows = [(Sample.NONE, f"Hidden: {', '.join(hidden)}")] if hidden else []
    rows += [(Sample.SOLID, "Marker as seen")] if what.review.marker_names else []
    outlines = view.footage.to_region(what.review.observed[what.index])
    return [
        Stroke(segments(outline, closed=True), style.color(color), style.width, style.halo)
        for outline, color in zip(outlines, what.colors, strict=True)
    ], rows


def _predicted(what: Shown, view: MotionView, style: Style) -> Part:
    """A dashed, paler outline of each region and of the body's contours; that of a hidden marker is named."""
    assert view.footage is not None
    review, to_region = what.review, view.footage.to_region
    dash, gap = style.dash * style.scale, style.gap * style.scale
    items: list[Item] = []
    rows = [(Sample.DASHED, "Marker as the motion predicts it")] if review.marker_names else []
    rows += [(Sample.DASHED, "Contour as the motion predicts it")] if review.contours.shape[1] else []
    for marker, outline in enumerate(to_region(review.predicted[what.index])):
        whole = outline[np.isfinite(outline).all(axis=-1)]
        if not len(whole):
            continue
        red, green, blue = what.colors[marker]
        pale = style.color((0.5 + 0.5 * red, 0.5 + 0.5 * green, 0.5 + 0.5 * blue))
        items.append(Stroke(dashes(whole, dash, gap, closed=True), pale, style.width, style.halo))
        if marker in what.hidden:
            words, y = f"{review.marker_names[marker]} hidden", float(whole[:, 1].mean())
            items.append(Label(words, float(whole[:, 0].max()) + gap, y, style.color(drawing.INK)))
    for line in to_region(review.contours[what.index]):
        items.append(Stroke(dashes(line, dash, gap), style.color(drawing.MIDDLE), style.width, style.halo))
    return items, rows


def _skeleton(what: Shown, view: MotionView, style: Style) -> Part:
    review, index = what.review, what.index
    (positions,) = view.point_positions(review, np.array([index]))
    state = TakeState(what.take)
    if state.keyed.all and state.actor is not None and state.shows_keyframes:
        positions = view.project(joint_places(state.actor))  # of what is stored, not of the earlier motion
    rows = [(Sample.LEFT, "Performer's left"), (Sample.RIGHT, "Performer's right")]
    rows += [(Sample.RING, "Uncertain point")] if (review.sigma_m[index] > drawing.UNCERTAIN_M).any() else []
    unsure = [name for name, is_unsure in zip(TURNED, review.unsure[index], strict=True) if is_unsure]
    rows += [(Sample.NONE, f"Turn hardly seen: {', '.join(unsure)}")] if unsure else []
    return skeleton(review, index, positions, view.pixels_per_meter(review, index), style), rows


def _keypoints(what: Shown, view: MotionView, style: Style) -> Part:
    assert view.footage is not None
    compared, index, to_region = what.review.keypoints, what.index, view.footage.to_region
    frame = round(float(what.review.frames[index]))
    seen = not_yet_compared(keypoints_at(what.take, frame), compared, index)
    sources = all_sources(compared, seen)
    rows = list(source_rows(sources))
    rows += [(Sample.EXPECTED, "Where the motion puts it")] if compared.names else []
    rows += [(Sample.THROWN_OUT, "Keypoint not believed")] if compared.thrown_out[index].any() else []
    rows += [(Sample.SWAPPED, "Left and right exchanged")] if compared.swapped[index].any() else []
    items = compared_marks(compared, index, to_region, sources, style)
    return items + seen_marks(seen, to_region, sources, style), rows


def source_rows(sources: tuple[str, ...]) -> tuple[Row, ...]:
    """A row for each source of keypoints, as far as their colors differ."""
    pairs = zip(SOURCE_SAMPLES, sources, strict=False)
    return tuple((sample, f"Keypoint of {source}") for sample, source in pairs)


PARTS: dict[str, Callable[[Shown, MotionView, Style], Part]] = {
    "paths": _paths,
    "observed": _observed,
    "predicted": _predicted,
    "skeleton": _skeleton,
    "keypoints": _keypoints,
}
"""By the switch that each has, the lowest first."""
ON_FOOTAGE = {"observed", "predicted", "keypoints"}
EXPLAINED = ("keypoints", "observed", "predicted", "skeleton", "paths")
"""The same from the top of the legend down."""


def shown(scene: Scene) -> Shown | None:
    """The active take's motion at the scene's frame; None without a motion there."""
    take = find_take(scene)
    review = None if take is None else review_of(take)
    if take is None or review is None or not len(review.frames):
        return None
    away = np.abs(review.frames - scene.frame_current_final)
    index = int(away.argmin())
    return Shown(take, review, index) if away[index] <= 0.75 else None


def draw(context: Context) -> list[Item]:
    """The motion in the scene's frame."""
    what = shown(context.scene)
    view = None if what is None else motion_view(context, what.take)
    if what is None or view is None:
        return []
    return picture(context, what, view, context.scene.keymark.overlays)


def picture(context: Context, what: Shown, view: MotionView, settings: PropertyGroup) -> list[Item]:
    """All enabled items, and their legend."""
    scale = ui_scale()
    meter = view.pixels_per_meter(what.review, what.index)
    style = Style(settings.opacity, scale, body_scale(meter, scale))
    parts = {
        name: part(what, view, style)
        for name, part in PARTS.items()
        if getattr(settings, f"show_{name}") and (view.footage is not None or name not in ON_FOOTAGE)
    }
    items = [item for drawn, _ in parts.values() for item in drawn]
    if settings.show_legend:
        rows = tuple(row for name in EXPLAINED if name in parts for row in parts[name][1])
        items += legend(rows, *corner(context.area, context.region, scale), style)
    return items


def draw_keypoints(context: Context) -> list[Item]:
    """The keypoints of the scene's frame."""
    scene = context.scene
    settings, take = scene.keymark.overlays, find_take(scene)
    hidden = context.space_data.type == "VIEW_3D" and not context.space_data.overlay.show_overlays
    if take is None or hidden or not settings.show_keypoints or shown(scene) is not None:
        return []
    view = footage_view(scene, take, context.area, context.region)
    seen = () if view is None else keypoints_at(take, scene.frame_current)
    return picture_keypoints(context, seen, view, settings) if view is not None and seen else []


def picture_keypoints(
    context: Context, seen: tuple[FrameKeypoints, ...], view: FootageView, settings: PropertyGroup
) -> list[Item]:
    """The keypoints of a frame, and their legend."""
    scale = ui_scale()
    rows = np.concatenate([view.to_region(each.pixel)[..., 1].ravel() for each in seen])
    height = np.ptp(rows[np.isfinite(rows)]) if np.isfinite(rows).any() else np.nan
    style = Style(settings.opacity, scale, body_scale(np.array([height / drawing.TALL_M]), scale))
    sources = all_sources(None, seen)
    items = seen_marks(seen, view.to_region, sources, style)
    if settings.show_legend:
        items += legend(source_rows(sources), *corner(context.area, context.region, scale), style)
    return items
