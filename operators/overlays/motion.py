"""The reconstructed motion as items to draw, whichever editor they are drawn in."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import bpy
import numpy as np

from ...core.arrays import Array, IndexArray
from ..keypoints.frame_keypoints import FrameKeypoints, keypoints_at
from ..shell.footage_view import FootageView
from ..shell.results import review_of
from ..shell.takes import find_take
from . import drawing
from .keypoint_marks import all_sources, compared_marks, not_yet_compared, seen_marks
from .keypoint_rows import keypoint_rows
from .legend import Row, Sample, corner, legend
from .outlines import MarkerColor, hidden_markers, observed_outlines, predicted_contours, predicted_outlines
from .paths import paths, window
from .picture import Item
from .skeleton import skeleton
from .style import PATH_POINTS, UNCERTAIN_M, Style, body_scale

if TYPE_CHECKING:
    from ...core.review.review import Review


UNKNOWN: MarkerColor = (0.8, 0.8, 0.8)
"""Color of a marker that was removed since the reconstruction."""
NEAREST = 0.75
"""Largest distance of the scene's frame from the clip's frame that it shows [frames]."""


class MotionView(Protocol):
    """A region of an editor as a view of the motion."""

    @property
    def footage(self) -> FootageView | None:
        """The footage's view, if the region shows the footage."""

    def point_positions(self, review: "Review", indices: IndexArray) -> Array:
        """Region pixels (I, 13, 2) of the points, NaN behind the viewer."""

    def pixels_per_meter(self, review: "Review", index: int) -> Array:
        """Size (13,) of a meter at each point."""


@dataclass(frozen=True, eq=False)
class Shown:
    """A frame of a take's motion that is drawn."""

    take: bpy.types.PropertyGroup
    review: "Review"
    index: int
    """Index in the clip of the scene's current frame."""


def shown(scene: bpy.types.Scene) -> Shown | None:
    """The active take's motion at the scene's frame; None without a motion there."""
    take = find_take(scene)
    review = None if take is None else review_of(take)
    if take is None or review is None or not len(review.frames):
        return None
    away = np.abs(review.frames - scene.frame_current_final)
    index = int(away.argmin())
    return Shown(take, review, index) if away[index] <= NEAREST else None


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
    colors = [chosen.get(name, UNKNOWN) for name in what.review.marker_names]
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
                words = f"Hidden: {', '.join(hidden)}"
                rows.append((Sample.NONE, words))
            rows.append((Sample.SOLID, "Marker as seen"))
        if settings.show_predicted:
            rows.append((Sample.DASHED, "Marker as the motion predicts it"))
    if view.footage is not None and what.review.contours.shape[1] and settings.show_predicted:
        rows.append((Sample.DASHED, "Contour as the motion predicts it"))
    if settings.show_skeleton:
        rows.append((Sample.LEFT, "Performer's left"))
        rows.append((Sample.RIGHT, "Performer's right"))
        if (what.review.sigma_m[what.index] > UNCERTAIN_M).any():
            rows.append((Sample.RING, "Uncertain point"))
    if settings.show_paths:
        rows.append((Sample.PAST, "Path so far"))
        rows.append((Sample.FUTURE, "Path to come"))
        rows.append((Sample.DIAMOND, "Keyframe"))
    return tuple(rows)
