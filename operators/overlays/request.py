"""Overlay of what an operator asks for: large at the top, and near the mouse; and of its brush."""

import bpy
import numpy as np

from ..shell.footage_request import FootageRequest, shown_request
from ..shell.footage_view import FootageView, footage_view
from ..shell.takes import find_take
from . import drawing
from .figures import segments

TITLE_SIZE, DETAIL_SIZE, NEAR_SIZE = 22.0, 14.0, 13.0
TOP_GAP, NEAR_GAP = 84.0, 18.0
"""Distances of the title from the region's top, where headers lie, and of the words from the mouse."""
CORNERS = 48
"""Of the brush's circle."""


def draw(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    take, request = find_take(context.scene), shown_request()
    if request is None or take is None:
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return
    scale, region = drawing.ui_scale(), context.region
    middle, top = 0.5 * region.width, region.height - TOP_GAP * scale
    drawing.text(request.title, middle, top, size=TITLE_SIZE, align="middle")
    if request.detail:
        below = top - 1.6 * DETAIL_SIZE * scale
        drawing.text(request.detail, middle, below, size=DETAIL_SIZE, align="middle")
    x, y = request.mouse[0] - region.x, request.mouse[1] - region.y
    if 0 <= x < region.width and 0 <= y < region.height:
        _near_mouse(request, view, float(x), float(y))


def _near_mouse(request: FootageRequest, view: FootageView, x: float, y: float) -> None:
    scale = drawing.ui_scale()
    if request.brush_px:
        drawing.lines(
            segments(brush_circle(request.brush_px, view, x, y), closed=True), drawing.INK, halo=1.0
        )
        return
    words = f"{request.title}, {request.detail}" if request.detail else request.title
    width = drawing.text_size(words, NEAR_SIZE)[0]
    left = min(x + NEAR_GAP * scale, view.region.width - width - NEAR_GAP * scale)
    drawing.text(words, left, y + NEAR_GAP * scale, size=NEAR_SIZE)


def brush_circle(radius_px: float, view: FootageView, x: float, y: float) -> np.ndarray:
    """The circle (N, 2) of a brush about a position in the region; its radius is in pixels of the footage."""
    angle = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
    around = radius_px * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return view.to_region(view.to_footage((x, y)) + around)
