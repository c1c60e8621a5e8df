"""Overlay of the regions that are never a marker: hatched, with the masks and under the brush."""

import bpy
import gpu
import numpy as np

from ...core.arrays import Image, SingleArray
from ..markers.brush import brush_at_work
from ..markers.mask_previews import ignored_mask
from ..shell.footage_view import footage_view
from ..shell.takes import find_take
from . import drawing
from .mask import draw_picture

STRIPE = 6
"""Pixels of the measuring grid from one stripe to the next."""
DARK, LIGHT = (0.0, 0.0, 0.0, 0.65), (1.0, 1.0, 1.0, 0.55)
"""Of any color's look, so that no marker can be taken for it."""

_drawn: dict[int, tuple[Image, gpu.types.GPUTexture]] = {}
"""Cache of one: the mask that was drawn last, and its texture."""


def draw(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    take, brush = find_take(context.scene), brush_at_work()
    if take is None or (brush is None and not context.window_manager.keymark_show_masks):
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return
    mask = ignored_mask(take, () if brush is None else brush.regions())
    if mask is None:
        return
    if 0 not in _drawn or _drawn[0][0] is not mask:
        _drawn[0] = (mask, drawing.texture(hatched(mask)))
    draw_picture(_drawn[0][1], view)


def hatched(mask: Image) -> SingleArray:
    """A mask as a picture (rows, columns, 4) of red, green, blue, alpha in 0 to 1, top row first."""
    row, column = np.indices(mask.shape)
    stripe = ((row + column) % STRIPE < STRIPE // 3)[..., None]
    picture = np.where(stripe, np.array(LIGHT), np.array(DARK))
    picture[mask == 0] = 0.0
    return picture.astype(np.float32)


def register() -> None:
    """Nothing is to be done before the first drawing."""


def unregister() -> None:
    """Release the texture."""
    _drawn.clear()
