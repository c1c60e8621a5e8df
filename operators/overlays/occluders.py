"""Overlay of what the motion takes to stand before the performer: a tint over the footage, with its edge."""

import bpy
import gpu
import numpy as np

from ...core.arrays import BoolArray, SingleArray
from ..shell.footage_view import footage_view
from ..shell.results import review_of
from ..shell.takes import find_take
from . import drawing
from .mask import draw_picture

TINT = (1.0, 0.45, 0.1, 0.4)
EDGE = (0.0, 0.0, 0.0, 0.6)
"""Dark, so that the tint shows on orange furniture as well."""

_drawn: dict[int, tuple[BoolArray, float, gpu.types.GPUTexture]] = {}
"""Cache of one: the map that was drawn last, its opacity, and its texture."""


def draw(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    take, settings = find_take(context.scene), context.scene.keymark.overlays
    review = None if take is None else review_of(take)
    if take is None or review is None or not settings.show_occluders or not review.occluders.any():
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return
    drawn = _drawn.get(0)
    if drawn is None or drawn[0] is not review.occluders or drawn[1] != settings.opacity:
        texture = drawing.texture(tinted(review.occluders, settings.opacity))
        drawn = _drawn[0] = (review.occluders, settings.opacity, texture)
    draw_picture(drawn[2], view)


def tinted(covered: BoolArray, opacity: float) -> SingleArray:
    """A map as a picture (rows, columns, 4) of red, green, blue, alpha in 0 to 1, top row first."""
    wide = np.pad(covered, 1, mode="edge")
    inner = covered & wide[:-2, 1:-1] & wide[2:, 1:-1] & wide[1:-1, :-2] & wide[1:-1, 2:]
    picture = np.zeros((*covered.shape, 4))
    picture[covered] = EDGE
    picture[inner] = TINT
    picture[..., 3] *= opacity
    return picture.astype(np.float32)


def register() -> None:
    """Nothing is to be done before the first drawing."""


def unregister() -> None:
    """Release the texture."""
    _drawn.clear()
