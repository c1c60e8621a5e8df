"""Overlay of the reconstructed motion: body, markers, keypoints, paths, and their legend."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from bpy.types import Context, PropertyGroup, Scene

from ...core.arrays import Array
from ..bridge.object_space import joint_places
from ..follow.frame_keypoints import FrameKeypoints, keypoints_at
from ..shell.footage_view import FootageView, footage_view
from ..shell.results import review_of
from ..shell.take_state import TakeState
from ..shell.takes import find_take
from . import drawing
from .drawing import Fill, Item, Label, Stroke, Style, body_scale, side_color, ui_scale
from .figures import circles, dashes, limb_lines, segments
from .legend import SOURCE_SAMPLES, Row, Sample, corner, legend
from .marks import all_sources, compared_marks, not_yet_compared, paths, seen_marks, window
from .views import MotionView, motion_view

if TYPE_CHECKING:
    from ...core.review.review import Review


def skeleton(
    review: "Review", index: int, positions: Array, pixels_per_meter: Array, style: Style
) -> list[Item]:
    """The body of one frame: its points (13, 2) in region pixels, and the size (13,) of a meter at each.

    Lines and discs have the colors of their sides; lines of the right have a dark core. An uncertain point is
    a ring, in a dashed circle as large as its standard deviation.
    """
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


# --- Parts of the picture: the items of each, and the rows of the legend that explain them


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
        """The colors of all markers."""
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
    """A solid outline of each marker's region that was found."""
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
    return skeleton(review, index, positions, view.pixels_per_meter(review, index), style), rows


def _keypoints(what: Shown, view: MotionView, style: Style) -> Part:
    """Those of the motion, and others that the take's sources see."""
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
    return tuple(
        (sample, f"Keypoint of {source}") for sample, source in zip(SOURCE_SAMPLES, sources, strict=False)
    )


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


# --- Overlay of keypoints where there is no motion yet


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
