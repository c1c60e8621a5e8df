"""Overlay of keypoints where there is no motion yet: what each source sees in the frame, over the footage."""

import bpy
import numpy as np

from ..keypoints.frame_keypoints import FrameKeypoints, keypoints_at
from ..shell.footage_view import FootageView, footage_view
from ..shell.takes import find_take
from . import drawing
from .keypoint_marks import all_sources, seen_marks
from .keypoint_rows import source_rows
from .legend import corner, legend
from .motion import shown
from .picture import Item, paint
from .style import Style, body_scale

TALL_M = 1.7
"""Height of a figure by which marks get smaller where it is small [m]."""


def draw(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    scene = context.scene
    settings, take = scene.keymark.overlays, find_take(scene)
    hidden = context.space_data.type == "VIEW_3D" and not context.space_data.overlay.show_overlays
    if take is None or hidden or not settings.show_keypoints or shown(scene) is not None:
        return
    view = footage_view(scene, take, context.area, context.region)
    seen = () if view is None else keypoints_at(take, scene.frame_current)
    if view is not None and seen:
        paint(picture(context, seen, view, settings))


def picture(
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
        at = corner(context.area, context.region, scale)
        items += legend(source_rows(sources), *at, style)
    return items
