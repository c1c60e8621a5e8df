"""Overlays of color masks, and of the regions that are never a marker."""

from collections.abc import Sequence
from time import monotonic

import bpy
import gpu
import numpy as np
from bpy.app.handlers import persistent
from gpu_extras.batch import batch_for_shader

from ...core.arrays import Image, SingleArray
from ...core.errors import KeymarkError
from ..follow.ignore_region import brush_at_work
from ..follow.mask_previews import (
    ColorMask,
    Preview,
    clear_previews,
    ignored_mask,
    is_of_frame,
    preview_of,
    update_masks,
)
from ..shell.footage_view import FootageView, footage_view, shown_request
from ..shell.takes import find_take
from . import drawing
from .figures import segments

DARKENING = 0.5
NAME_GAP = 4.0  # between an outline and the name above it [unscaled px]
LARGEST_SHARE = 0.2
"""Of a frame's time: masks that take longer are not made while the animation plays. Overlays together are to
take at most a third."""
STRIPES = (0.0, 0.0, 0.0, 0.65), (1.0, 1.0, 1.0, 0.55)  # of no marker's look

_drawn: dict[int, tuple[tuple[ColorMask, ...], float, gpu.types.GPUTexture]] = {}
"""Cache of one: the masks that were drawn last, how dark all else was, and their texture."""
_ignored: dict[int, tuple[Image, gpu.types.GPUTexture]] = {}
"""Cache of one: the ignored regions that were drawn last, and their texture."""


def draw(context: bpy.types.Context) -> None:
    """Draw the masks of the scene's frame."""
    take = find_take(context.scene)
    if take is None or not context.window_manager.keymark_show_masks:
        return
    preview = preview_of(take)
    if preview is None or not preview.masks or not is_of_frame(preview, context.scene):
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is not None:
        draw_masks(preview, view)


def draw_masks(preview: Preview, view: FootageView) -> None:
    """Draw the masks of a preview over its footage, with their outlines and names."""
    _draw_picture(_texture(preview), view)
    for mask in preview.masks:
        for outline in mask.outlines:
            drawing.lines(segments(view.to_region(outline), closed=True), drawing.INK, 1.5, 0.8)
    _draw_names(preview.masks, view)


def tinted(masks: Sequence[ColorMask], darkening: float = DARKENING) -> SingleArray:
    """The masks as a picture (rows, columns, 4) of red, green, blue, alpha in 0 to 1, top row first."""
    rows, columns = masks[0].coverage.shape
    picture = np.zeros((rows, columns, 4), dtype=np.float32)
    picture[..., 3] = darkening
    for mask in masks:
        share = mask.coverage[..., None]
        picture = (1.0 - share) * picture + share * np.array([*mask.color, 0.65], dtype=np.float32)
    return picture.astype(np.float32)


def _texture(preview: Preview) -> gpu.types.GPUTexture:
    """The texture of a preview's masks, cached; what is still to be clicked on is not darkened."""
    darkening = DARKENING if shown_request() is None else 0.0
    if 0 not in _drawn or _drawn[0][0] is not preview.masks or _drawn[0][1] != darkening:
        _drawn[0] = (preview.masks, darkening, drawing.texture(tinted(preview.masks, darkening)))
    return _drawn[0][2]


def _draw_picture(texture: gpu.types.GPUTexture, view: FootageView) -> None:
    """Draw a texture over the footage, distorted as the view shows the footage."""
    cells = 24 if view.lens is not None else 1  # they follow the lens distortion
    steps = np.linspace(0.0, 1.0, cells + 1)
    across, down = np.meshgrid(steps, steps)
    shares = np.stack([across, down], axis=-1)
    corners = np.stack([shares[:-1, :-1], shares[:-1, 1:], shares[1:, 1:], shares[1:, :-1]], axis=-2)
    triangles = corners.reshape(-1, 4, 2)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 2)
    vertices = np.zeros((len(triangles), 3), dtype=np.float32)
    vertices[:, :2] = view.to_region(triangles * view.size)
    # Textures begin at the bottom.
    ends = (triangles * [1.0, -1.0] + [0.0, 1.0]).astype(np.float32)
    shader = gpu.shader.from_builtin("IMAGE_COLOR")
    batch = batch_for_shader(shader, "TRIS", {"pos": vertices, "texCoord": ends})
    shader.uniform_sampler("image", texture)
    shader.uniform_float("color", (1.0, 1.0, 1.0, 1.0))
    batch.draw(shader)


def _draw_names(masks: Sequence[ColorMask], view: FootageView) -> None:
    """Write each mask's name above its larger outlines, higher where another name is."""
    scale = drawing.ui_scale()
    boxes: list[tuple[float, float, float, float]] = []
    for mask in masks:
        width, height = drawing.text_size(mask.label)
        longest = len(mask.outlines[0]) if mask.outlines else 0
        for outline in mask.outlines:
            if len(outline) >= 0.25 * longest:
                points = view.to_region(outline)
                x, y = float(points[:, 0].mean()), float(points[:, 1].max()) + NAME_GAP * scale
                left, tall = x - 0.5 * width, height + NAME_GAP * scale
                y = free_height((left, y, width, tall), boxes)
                boxes.append((left, y, width, tall))
                drawing.text(mask.label, x, y, align="middle")


def free_height(
    box: tuple[float, float, float, float], taken: Sequence[tuple[float, float, float, float]]
) -> float:
    """The least y at or above a box's own at which it overlaps no other; a box is x, y, width, height."""
    x, y, width, height = box
    beside = [other for other in taken if x < other[0] + other[2] and other[0] < x + width]
    for other in sorted(beside, key=lambda one: one[1]):
        if y < other[1] + other[3] and other[1] < y + height:
            y = other[1] + other[3]
    return y


# --- Regions that are never a marker


def draw_ignored(context: bpy.types.Context) -> None:
    """Draw the regions that are never a marker, with the masks and while they are painted."""
    take, brush = find_take(context.scene), brush_at_work()
    if take is None or (brush is None and not context.window_manager.keymark_show_masks):
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return
    mask = ignored_mask(take, () if brush is None else brush.regions())
    if mask is None:
        return
    if 0 not in _ignored or _ignored[0][0] is not mask:
        _ignored[0] = (mask, drawing.texture(hatched(mask)))
    _draw_picture(_ignored[0][1], view)


def hatched(mask: Image) -> SingleArray:
    """A mask as a striped picture (rows, columns, 4) of red, green, blue, alpha in 0 to 1, top row first."""
    row, column = np.indices(mask.shape)
    stripe = ((row + column) % 6 < 2)[..., None]
    picture = np.where(stripe, np.array(STRIPES[1]), np.array(STRIPES[0]))
    picture[mask == 0] = 0.0
    return picture.astype(np.float32)


# --- Masks of the frame that the scene goes to


@persistent
def _frame_changed(scene: bpy.types.Scene, _depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Make the masks of the scene's current frame."""
    if not bpy.context.window_manager.keymark_show_masks or bpy.app.is_job_running("RENDER"):
        return
    played = any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)
    if played and not _cost.is_fast(scene):
        return  # `draw` shows none that are of another frame
    try:
        started = monotonic()
        update_masks(scene)
        _cost.last_s = monotonic() - started
    except KeymarkError:
        clear_previews()  # the clip is missing, which the operator that shows masks reports


@persistent
def _stopped(scene: bpy.types.Scene, _depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Make the masks that playback has left out."""
    _cost.last_s = 0.0
    _frame_changed(scene)


class Cost:
    """How long the masks of a frame took to make."""

    last_s = 0.0

    def is_fast(self, scene: bpy.types.Scene) -> bool:
        """Whether they take no more than their share of a frame's time, so that playback keeps its speed."""
        return self.last_s <= LARGEST_SHARE * scene.render.fps_base / scene.render.fps


_cost = Cost()


def register() -> None:
    """Follow the scene's frame, unless Blender runs in the background."""
    if not bpy.app.background:
        bpy.app.handlers.frame_change_post.append(_frame_changed)
        bpy.app.handlers.animation_playback_post.append(_stopped)


def unregister() -> None:
    """Stop following it; release textures and open files."""
    if _frame_changed in bpy.app.handlers.frame_change_post:
        bpy.app.handlers.frame_change_post.remove(_frame_changed)
        bpy.app.handlers.animation_playback_post.remove(_stopped)
    _drawn.clear()
    _ignored.clear()
    clear_previews()
