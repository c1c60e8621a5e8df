"""Overlay of the reconstructed motion: body, markers, keypoints, paths, and their legend."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.arrays import Array, BoolArray
from ..follow.frame_keypoints import FrameKeypoints, keypoints_at
from ..shell.footage_view import FootageView, footage_view
from ..shell.results import review_of
from ..shell.takes import find_take
from . import drawing
from .drawing import (
    CORE,
    PATH_POINTS,
    SIDES,
    TALL_M,
    UNCERTAIN_M,
    Fill,
    Item,
    Stroke,
    Style,
    body_scale,
    paint,
    side_color,
)
from .figures import circles, limb_lines, segments
from .keypoint_marks import all_sources, compared_marks, not_yet_compared, seen_marks
from .legend import SOURCE_SAMPLES, Row, Sample, corner, legend
from .outlines import (
    hidden_markers,
    observed_outlines,
    paths,
    predicted_contours,
    predicted_outlines,
    window,
)
from .views import MotionView, clip_view, world_view

if TYPE_CHECKING:
    from ...core.review.compared_keypoints import ComparedKeypoints
    from ...core.review.review import Review


def skeleton(
    review: "Review", index: int, positions: Array, pixels_per_meter: Array, style: Style
) -> list[Item]:
    """The body of one frame: its points (13, 2) in region pixels, and the size (13,) of a meter at each."""
    sigma = review.sigma_m[index]
    uncertain = sigma > UNCERTAIN_M
    colors = np.array([style.color(side_color(name)) for name in review.point_names])
    return [
        *_limbs(review.point_names, positions, style),
        *_joints(positions, uncertain, colors, style),
        _deviations(positions[uncertain], (sigma * pixels_per_meter)[uncertain], colors[uncertain], style),
    ]


def _limbs(names: tuple[str, ...], positions: Array, style: Style) -> list[Item]:
    """Lines in the colors of their sides; those of the right have a dark core."""
    lines, sides = limb_lines(names, positions)
    colors = np.array([style.color(SIDES[side]) for side in sides.tolist()]).reshape(-1, 4)
    width = style.limb * style.width * style.body_scale
    return [
        Stroke(lines, colors, width, style.halo),
        Stroke(lines[sides == "R"], style.color(CORE), style.core * width),
    ]


def _joints(positions: Array, uncertain: BoolArray, colors: Array, style: Style) -> list[Item]:
    """Discs, and rings for uncertain points."""
    rims = circles(positions, style.size(style.joint), 16)
    seen = np.isfinite(positions).all(axis=-1)
    edges = Stroke(segments(rims[seen], closed=True), np.repeat(colors[seen], 16, axis=0), 1.5, style.halo)
    return [edges, Fill(rims[seen & ~uncertain], colors[seen & ~uncertain])]


def _deviations(positions: Array, radii: Array, colors: Array, style: Style) -> Stroke:
    """Dashed circles as large as the points' standard deviations."""
    seen = np.isfinite(positions).all(axis=-1) & np.isfinite(radii)
    parts = segments(circles(positions[seen], radii[seen], 48), closed=True)[::2]
    return Stroke(parts, np.repeat(colors[seen], 24, axis=0), 1.0, style.halo)


# --- Rows of the legend that explain keypoints


def keypoint_rows(
    keypoints: "ComparedKeypoints", index: int, seen: tuple[FrameKeypoints, ...]
) -> tuple[Row, ...]:
    """Rows for what a frame shows of keypoints: those of a motion, and others that a take's sources see."""
    rows = list(source_rows(all_sources(keypoints, seen)))
    if keypoints.names:
        rows.append((Sample.EXPECTED, "Where the motion puts it"))
    if keypoints.thrown_out[index].any():
        rows.append((Sample.THROWN_OUT, "Keypoint not believed"))
    if keypoints.swapped[index].any():
        rows.append((Sample.SWAPPED, "Left and right exchanged"))
    return tuple(rows)


def source_rows(sources: tuple[str, ...]) -> tuple[Row, ...]:
    """A row for each source of keypoints, as far as their colors differ."""
    return tuple(
        (sample, f"Keypoint of {source}") for sample, source in zip(SOURCE_SAMPLES, sources, strict=False)
    )


@dataclass(frozen=True, eq=False)
class Shown:
    """A frame of a take's motion that is drawn."""

    take: bpy.types.PropertyGroup
    review: "Review"
    index: int  # index in the clip of the scene's current frame


def shown(scene: bpy.types.Scene) -> Shown | None:
    """The active take's motion at the scene's frame; None without a motion there."""
    take = find_take(scene)
    review = None if take is None else review_of(take)
    if take is None or review is None or not len(review.frames):
        return None
    away = np.abs(review.frames - scene.frame_current_final)
    index = int(away.argmin())
    return Shown(take, review, index) if away[index] <= 0.75 else None


def picture(
    context: bpy.types.Context, what: Shown, view: MotionView, settings: bpy.types.PropertyGroup
) -> list[Item]:
    """All enabled items, and their legend."""
    scale = drawing.ui_scale()
    meter = view.pixels_per_meter(what.review, what.index)
    style = Style(settings.opacity, scale, body_scale(meter, scale))
    items: list[Item] = []
    if settings.show_paths:
        items += _paths(what, view, style)
    if view.footage is not None:
        items += _outlines(what, view.footage, settings, style)
    seen = _seen(what) if view.footage is not None and settings.show_keypoints else ()
    if settings.show_skeleton:
        (positions,) = view.point_positions(what.review, np.array([what.index]))
        items += skeleton(what.review, what.index, positions, meter, style)
    if view.footage is not None and settings.show_keypoints:
        sources, to_region = all_sources(what.review.keypoints, seen), view.footage.to_region
        items += compared_marks(what.review.keypoints, what.index, to_region, sources, style)
        items += seen_marks(seen, to_region, sources, style)
    if settings.show_legend:
        rows = _rows(what, view, settings, seen)
        items += legend(rows, *corner(context.area, context.region, scale), style)
    return items


def _outlines(
    what: Shown, footage: FootageView, settings: bpy.types.PropertyGroup, style: Style
) -> list[Item]:
    chosen = {marker.name: tuple(marker.color) for marker in what.take.markers}
    colors = [chosen.get(name, (0.8, 0.8, 0.8)) for name in what.review.marker_names]
    items: list[Item] = []
    if settings.show_observed:
        items += observed_outlines(what.review, what.index, footage.to_region, colors, style)
    if settings.show_predicted:
        items += predicted_outlines(what.review, what.index, footage.to_region, colors, style)
        items += predicted_contours(what.review, what.index, footage.to_region, style)
    return items


def _seen(what: Shown) -> tuple[FrameKeypoints, ...]:
    """Keypoints of the frame that the motion was not held against."""
    frame = round(float(what.review.frames[what.index]))
    return not_yet_compared(keypoints_at(what.take, frame), what.review.keypoints, what.index)


def _paths(what: Shown, view: MotionView, style: Style) -> list[Item]:
    review = what.review
    frames = window(what.index, len(review.frames))
    chosen = [point for point, name in enumerate(review.point_names) if name in PATH_POINTS]
    names = [review.point_names[point] for point in chosen]
    positions = np.swapaxes(view.point_positions(review, frames)[:, chosen], 0, 1)
    return paths(names, positions, frames, what.index, review.keyframe_indices, style)


def _rows(
    what: Shown, view: MotionView, settings: bpy.types.PropertyGroup, seen: tuple[FrameKeypoints, ...]
) -> tuple[Row, ...]:
    """Rows of the legend, for drawn items only."""
    rows: list[Row] = []
    if view.footage is not None and settings.show_keypoints:
        rows += keypoint_rows(what.review.keypoints, what.index, seen)
    if view.footage is not None and what.review.marker_names:
        if settings.show_observed:
            hidden = [what.review.marker_names[marker] for marker in hidden_markers(what.review, what.index)]
            if hidden:
                rows.append((Sample.NONE, f"Hidden: {', '.join(hidden)}"))
            rows.append((Sample.SOLID, "Marker as seen"))
        if settings.show_predicted:
            rows.append((Sample.DASHED, "Marker as the motion predicts it"))
    if view.footage is not None and what.review.contours.shape[1] and settings.show_predicted:
        rows.append((Sample.DASHED, "Contour as the motion predicts it"))
    if settings.show_skeleton:
        rows += [(Sample.LEFT, "Performer's left"), (Sample.RIGHT, "Performer's right")]
        if (what.review.sigma_m[what.index] > UNCERTAIN_M).any():
            rows.append((Sample.RING, "Uncertain point"))
    if settings.show_paths:
        rows += [(Sample.PAST, "Path so far"), (Sample.FUTURE, "Path to come"), (Sample.DIAMOND, "Keyframe")]
    return tuple(rows)


def draw_viewport(context: bpy.types.Context) -> None:
    """Draw the motion into a 3D viewport."""
    what = shown(context.scene)
    if what is None or not context.space_data.overlay.show_overlays:
        return
    footage = footage_view(context.scene, what.take, context.area, context.region)
    view = world_view(context.region, context.region_data, footage)
    paint(picture(context, what, view, context.scene.keymark.overlays))


def draw_clip_editor(context: bpy.types.Context) -> None:
    """Draw the motion into a Movie Clip editor."""
    scene, what = context.scene, shown(context.scene)
    if what is None or context.space_data.view != "CLIP" or what.take.camera is None:
        return
    footage = footage_view(scene, what.take, context.area, context.region)
    if footage is not None:
        paint(picture(context, what, clip_view(scene, what.take, footage), scene.keymark.overlays))


# --- Overlay of keypoints where there is no motion yet


def draw_keypoints(context: bpy.types.Context) -> None:
    """Draw the keypoints of the scene's frame."""
    scene = context.scene
    settings, take = scene.keymark.overlays, find_take(scene)
    hidden = context.space_data.type == "VIEW_3D" and not context.space_data.overlay.show_overlays
    if take is None or hidden or not settings.show_keypoints or shown(scene) is not None:
        return
    view = footage_view(scene, take, context.area, context.region)
    seen = () if view is None else keypoints_at(take, scene.frame_current)
    if view is not None and seen:
        paint(picture_keypoints(context, seen, view, settings))


def picture_keypoints(
    context: bpy.types.Context,
    seen: tuple[FrameKeypoints, ...],
    view: FootageView,
    settings: bpy.types.PropertyGroup,
) -> list[Item]:
    """The keypoints of a frame, and their legend."""
    scale = drawing.ui_scale()
    rows = np.concatenate([view.to_region(each.pixel)[..., 1].ravel() for each in seen])
    height = np.ptp(rows[np.isfinite(rows)]) if np.isfinite(rows).any() else np.nan
    style = Style(settings.opacity, scale, body_scale(np.array([height / TALL_M]), scale))
    sources = all_sources(None, seen)
    items = seen_marks(seen, view.to_region, sources, style)
    if settings.show_legend:
        items += legend(source_rows(sources), *corner(context.area, context.region, scale), style)
    return items
