"""Overlays of color masks, and of the regions that are never a marker."""

from collections.abc import Callable, Sequence
from time import monotonic

import bpy
import gpu
import numpy as np
from bpy.app.handlers import persistent
from bpy.types import Context, Depsgraph, Scene

from ...core.arrays import Image, SingleArray
from ...core.errors import KeymarkError
from ..follow import mask_previews
from ..follow.marker_tools import Brush
from ..follow.mask_previews import ColorMask, Preview, clear_previews
from ..shell.footage_view import FootageView, footage_view, shown_request
from ..shell.takes import find_take
from .drawing import INK, Item, Label, Picture, Stroke, text_size, texture, ui_scale
from .figures import segments

DARKENING = 0.5
LARGEST_SHARE = 0.2
"""Of a frame's time: masks that take longer are not made while the animation plays. Overlays together are to
take at most a third."""

_textures: dict[str, tuple[object, gpu.types.GPUTexture]] = {}
"""By what it shows, the texture that was drawn last, and what it was made of."""


def draw(context: Context) -> list[Item]:
    """The masks of the scene's frame."""
    take = find_take(context.scene)
    if take is None or not context.window_manager.keymark_show_masks:
        return []
    preview = mask_previews.preview_of(take)
    if preview is None or not preview.masks or not mask_previews.is_of_frame(preview, context.scene):
        return []
    view = footage_view(context.scene, take, context.area, context.region)
    return [] if view is None else mask_items(preview, view)


def mask_items(preview: Preview, view: FootageView) -> list[Item]:
    """The masks of a preview over its footage, with their outlines and names."""
    # What is still to be clicked on is not darkened.
    darkening = DARKENING if shown_request() is None else 0.0
    drawn = _texture(f"masks {darkening}", preview.masks, lambda: tinted(preview.masks, darkening))
    outlines = [
        Stroke(segments(view.to_region(outline), closed=True), INK, 1.5, 0.8)
        for mask in preview.masks
        for outline in mask.outlines
    ]
    return [over_footage(drawn, view), *outlines, *_names(preview.masks, view)]


def tinted(masks: Sequence[ColorMask], darkening: float = DARKENING) -> SingleArray:
    """The masks as a picture (rows, columns, 4) of red, green, blue, alpha in 0 to 1, top row first."""
    picture = np.zeros((*masks[0].coverage.shape, 4), dtype=np.float32)
    picture[..., 3] = darkening
    for mask in masks:
        share = mask.coverage[..., None]
        picture = (1.0 - share) * picture + share * np.array([*mask.color, 0.65], dtype=np.float32)
    return picture.astype(np.float32)


def _texture(what: str, made_of: object, make: Callable[[], SingleArray]) -> gpu.types.GPUTexture:
    if what not in _textures or _textures[what][0] is not made_of:
        _textures[what] = made_of, texture(make())
    return _textures[what][1]


def over_footage(drawn: gpu.types.GPUTexture, view: FootageView) -> Picture:
    """A texture over the footage, distorted as the view shows the footage."""
    cells = 24 if view.lens is not None else 1  # they follow the lens distortion
    steps = np.linspace(0.0, 1.0, cells + 1)
    shares = np.stack(np.meshgrid(steps, steps), axis=-1)
    corners = np.stack([shares[:-1, :-1], shares[:-1, 1:], shares[1:, 1:], shares[1:, :-1]], axis=-2)
    triangles = corners.reshape(-1, 4, 2)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3, 2)
    return Picture(drawn, view.to_region(triangles * view.size), triangles)


def _names(masks: Sequence[ColorMask], view: FootageView) -> list[Label]:
    labels: list[Label] = []
    boxes: list[tuple[float, float, float, float]] = []
    gap = 4.0 * ui_scale()
    for mask in masks:
        width, height = text_size(mask.label)
        longest = len(mask.outlines[0]) if mask.outlines else 0
        for outline in mask.outlines:
            if len(outline) >= 0.25 * longest:
                points = view.to_region(outline)
                x, y = float(points[:, 0].mean()), float(points[:, 1].max()) + gap
                y = free_height((x - 0.5 * width, y, width, height + gap), boxes)
                boxes.append((x - 0.5 * width, y, width, height + gap))
                labels.append(Label(mask.label, x, y, align="middle"))
    return labels


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


def draw_ignored(context: Context) -> list[Item]:
    """The regions that are never a marker, with the masks and while they are painted."""
    take, brush = find_take(context.scene), Brush.at_work
    if take is None or (brush is None and not context.window_manager.keymark_show_masks):
        return []
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return []
    mask = mask_previews.ignored_mask(take, () if brush is None else brush.regions())
    if mask is None:
        return []
    return [over_footage(_texture("ignored", mask, lambda: hatched(mask)), view)]


def hatched(mask: Image) -> SingleArray:
    """A mask as a striped picture (rows, columns, 4) of red, green, blue, alpha in 0 to 1, top row first."""
    row, column = np.indices(mask.shape)
    stripe = ((row + column) % 6 < 2)[..., None]
    # Of no marker's look.
    picture = np.where(stripe, np.array((1.0, 1.0, 1.0, 0.55)), np.array((0.0, 0.0, 0.0, 0.65)))
    picture[mask == 0] = 0.0
    return picture.astype(np.float32)


_cost_s = 0.0
"""How long the masks of the last frame took to make."""


def is_fast(cost_s: float, scene: Scene) -> bool:
    """Whether masks take no more than their share of a frame's time, so that playback keeps its speed."""
    return cost_s <= LARGEST_SHARE * scene.render.fps_base / scene.render.fps


@persistent
def _frame_changed(scene: Scene, _depsgraph: Depsgraph | None = None) -> None:
    """Make the masks of the scene's current frame; in playback only where the last ones were fast."""
    global _cost_s
    if not bpy.context.window_manager.keymark_show_masks or bpy.app.is_job_running("RENDER"):
        return  # as in the background, where nobody has shown them
    played = any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)
    if played and not is_fast(_cost_s, scene):
        return  # `draw` shows none that are of another frame
    try:
        started = monotonic()
        mask_previews.update_masks(scene)
        _cost_s = monotonic() - started
    except KeymarkError:
        clear_previews()  # the clip is missing, which the operator that shows masks reports


@persistent
def _stopped(scene: Scene, _depsgraph: Depsgraph | None = None) -> None:
    """Make the masks that playback has left out."""
    global _cost_s
    _cost_s = 0.0
    _frame_changed(scene)


HANDLERS = {"frame_change_post": _frame_changed, "animation_playback_post": _stopped}


def detach() -> None:
    """Release textures and open files."""
    _textures.clear()
    clear_previews()
