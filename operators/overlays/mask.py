"""Items of an overlay as data: made without a screen, painted in few draw calls."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from time import monotonic
from typing import Literal

import bpy
import gpu
import numpy as np
from bpy.app.handlers import persistent
from gpu_extras.batch import batch_for_shader
from numpy.typing import ArrayLike

from ...core.arrays import Array, SingleArray
from ...core.errors import KeymarkError
from ..follow.mask_previews import ColorMask, Preview, clear_previews, is_of_frame, preview_of, update_masks
from ..shell.footage_view import FootageView, footage_view, shown_request
from ..shell.takes import find_take
from . import drawing
from .drawing import Color
from .figures import segments


@dataclass(frozen=True, eq=False)
class Stroke:
    """Straight lines."""

    segments: Array
    """(S, 2, 2) region pixels."""
    color: ArrayLike
    """(4,) for all, or (S, 4)."""
    width: float
    halo: float = 0.0
    """Opacity of the dark edge."""


@dataclass(frozen=True, eq=False)
class Fill:
    """Filled convex polygons."""

    corners: Array
    """(N, K, 2) region pixels."""
    color: ArrayLike
    """(4,) for all, or (N, 4)."""


@dataclass(frozen=True)
class Label:
    """A line of text; `x` is the position of the part that `align` names, `y` the base line [region px]."""

    words: str
    x: float
    y: float
    color: Color = drawing.INK
    align: Literal["left", "middle", "right"] = "left"


Item = Stroke | Fill | Label


def paint(items: Iterable[Item]) -> None:
    """Draw all items, the first at the bottom; alike neighbors in one draw call."""
    for item in merged(items):
        if isinstance(item, Stroke):
            drawing.lines(item.segments, item.color, item.width, item.halo)
        elif isinstance(item, Fill):
            drawing.polygons(item.corners, item.color)
        else:
            drawing.text(item.words, item.x, item.y, item.color, align=item.align)


def merged(items: Iterable[Item]) -> list[Item]:
    """Merge neighboring lines of one thickness, and neighboring polygons of equally many corners."""
    done: list[Item] = []
    for _, group in groupby(items, key=_kind):
        alike = list(group)
        first = alike[0]
        if isinstance(first, Stroke) and len(alike) > 1:
            parts = [(item.segments, item.color) for item in alike if isinstance(item, Stroke)]
            done.append(Stroke(*_joined(parts), first.width, first.halo))
        elif isinstance(first, Fill) and len(alike) > 1:
            done.append(
                Fill(*_joined([(item.corners, item.color) for item in alike if isinstance(item, Fill)]))
            )
        else:
            done += alike
    return done


def _kind(item: Item) -> tuple[object, ...]:
    if isinstance(item, Stroke):
        return ("stroke", item.width, item.halo)
    return ("fill", item.corners.shape[-2]) if isinstance(item, Fill) else ("label",)


def _joined(parts: list[tuple[Array, ArrayLike]]) -> tuple[Array, Array]:
    """Concatenated points, and a color for each."""
    points = np.concatenate([part for part, _ in parts])
    colors = [np.broadcast_to(np.asarray(color, dtype=np.float64), (len(part), 4)) for part, color in parts]
    return points, np.concatenate(colors)


# --- Overlay of color masks


DARKENING = 0.5
TINT = 0.65
WIDTH = 1.5
HALO = 0.8
NAME_GAP = 4.0
"""Distance between an outline and the name above it [unscaled px]."""
SHORTEST_NAMED = 0.25
"""Share of the longest outline's length below which outlines get no name."""
LARGEST_SHARE = 0.2
"""Of a frame's time: masks that take longer are not made while the animation plays. Overlays together are to
take at most a third."""
MESH = 24
"""Cells across the picture, which follow the lens distortion."""

_drawn: dict[int, tuple[tuple[ColorMask, ...], float, gpu.types.GPUTexture]] = {}
"""Cache of one: the masks that were drawn last, how dark all else was, and their texture."""


def draw(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
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
    """Draw the masks of a preview in the region of a view."""
    draw_picture(_texture(preview), view)
    for mask in preview.masks:
        _outlines(mask, view)
    _names(preview.masks, view)


def tinted(masks: Sequence[ColorMask], darkening: float = DARKENING) -> SingleArray:
    """The masks as a picture (rows, columns, 4) of red, green, blue, alpha in 0 to 1, top row first."""
    rows, columns = masks[0].coverage.shape
    picture = np.zeros((rows, columns, 4), dtype=np.float32)
    picture[..., 3] = darkening
    for mask in masks:
        share = mask.coverage[..., None]
        picture = (1.0 - share) * picture + share * np.array([*mask.color, TINT], dtype=np.float32)
    return picture.astype(np.float32)


def _texture(preview: Preview) -> gpu.types.GPUTexture:
    """The texture of a preview's masks, cached; what is still to be clicked on is not darkened."""
    darkening = DARKENING if shown_request() is None else 0.0
    if 0 not in _drawn or _drawn[0][0] is not preview.masks or _drawn[0][1] != darkening:
        _drawn[0] = (preview.masks, darkening, drawing.texture(tinted(preview.masks, darkening)))
    return _drawn[0][2]


def draw_picture(texture: gpu.types.GPUTexture, view: FootageView) -> None:
    """Draw a texture over the footage, distorted as the view shows the footage."""
    cells = MESH if view.lens is not None else 1
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


def _outlines(mask: ColorMask, view: FootageView) -> None:
    """Draw a mask's outlines."""
    for outline in mask.outlines:
        drawing.lines(segments(view.to_region(outline), closed=True), drawing.INK, WIDTH, HALO)


def _names(masks: Sequence[ColorMask], view: FootageView) -> None:
    """Draw each mask's name above its larger outlines, higher where another name is."""
    scale = drawing.ui_scale()
    boxes: list[tuple[float, float, float, float]] = []
    for mask in masks:
        width, height = drawing.text_size(mask.label)
        longest = len(mask.outlines[0]) if mask.outlines else 0
        for outline in mask.outlines:
            if len(outline) >= SHORTEST_NAMED * longest:
                points = view.to_region(outline)
                x, y = float(points[:, 0].mean()), float(points[:, 1].max()) + NAME_GAP * scale
                y = free_height((x - 0.5 * width, y, width, height + NAME_GAP * scale), boxes)
                boxes.append((x - 0.5 * width, y, width, height + NAME_GAP * scale))
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


@persistent
def _frame_changed(scene: bpy.types.Scene, _depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Make the masks of the scene's current frame."""
    if not bpy.context.window_manager.keymark_show_masks or bpy.app.is_job_running("RENDER"):
        return
    if is_played() and not _cost.is_fast(scene):
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


def is_played() -> bool:
    """Whether any window plays the animation."""
    return any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)


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
    clear_previews()
