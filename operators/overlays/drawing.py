"""Drawing primitives for a region: lines, polygons, textures and text, on Blender 4.5 to 5.2.

For draw functions of `registry`, which has enabled blending. Colors are red, green, blue and alpha in sRGB,
0 to 1, as users pick them. Shaders are made at the first call: without a window Blender has none.
"""

from collections.abc import Sequence
from typing import Literal

import blf
import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from numpy.typing import ArrayLike

from ...core.arrays import Array, SingleArray
from .figures import triangles

Color = tuple[float, float, float, float]

HALO: Color = (0.0, 0.0, 0.0, 0.75)
"""Dark edge that sets lines off from footage of any brightness."""
INK: Color = (1.0, 1.0, 1.0, 1.0)
HALO_PX = 1.25
"""Width of a halo on each side of its line."""
FONT = 0
TEXT_SIZE = 11.0
OUTLINED_TEXT = 6
"""The blur level that blf draws as an outline instead of a shadow."""
ALIGNMENTS = {"left": 0.0, "middle": 0.5, "right": 1.0}


def ui_scale() -> float:
    """Screen pixels for each unscaled pixel: resolution scale and high-density screens."""
    return float(bpy.context.preferences.system.ui_scale) or 1.0  # 0 before there is a window


def faded(color: Sequence[float], opacity: float) -> Color:
    """A color of three or four numbers with its alpha multiplied by `opacity`."""
    red, green, blue, *alpha = color
    return (red, green, blue, (alpha[0] if alpha else 1.0) * opacity)


def lines(segments: Array, color: ArrayLike, width: float = 1.5, halo: float = 0.0) -> None:
    """Draw straight segments.

    Args:
        segments: (S, 2, 2) region pixels, or (S, 2, 3) points in the space being drawn.
        color: (4,) one for all, or (S, 4) one each.
        width: Thickness, scaled with the user interface.
        halo: Opacity of a dark edge on both sides, 0 to 1.
    """
    if not len(segments):
        return
    if halo > 0.0:
        _polyline(segments, faded(HALO, halo), width + 2.0 * HALO_PX)
    _polyline(segments, color, width)


def _polyline(segments: Array, color: ArrayLike, width: float) -> None:
    colors = np.asarray(color, dtype=np.float32)
    each = colors.ndim > 1
    shader = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR" if each else "POLYLINE_UNIFORM_COLOR")
    content = {"pos": _positions(segments)}
    if each:
        content["color"] = np.repeat(colors, 2, axis=0)
    batch = batch_for_shader(shader, "LINES", content)
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width * ui_scale())
    if not each:
        shader.uniform_float("color", tuple(colors.tolist()))
    batch.draw(shader)


def polygons(corners: ArrayLike, color: ArrayLike) -> None:
    """Fill convex polygons.

    Args:
        corners: (N, K, D) region pixels or points in space; polygons that are not finite are left out.
        color: (4,) one for all, or (N, 4) one each.
    """
    points = np.asarray(corners, dtype=np.float64)
    if not len(points):
        return
    colors = np.asarray(color, dtype=np.float32)
    whole = np.isfinite(points).all(axis=(-2, -1))
    content = {"pos": _positions(triangles(points[whole]))}
    if not len(content["pos"]):
        return
    if colors.ndim == 1:
        shader = gpu.shader.from_builtin("UNIFORM_COLOR")
        batch = batch_for_shader(shader, "TRIS", content)
        shader.uniform_float("color", tuple(colors.tolist()))
    else:
        shader = gpu.shader.from_builtin("SMOOTH_COLOR")
        content["color"] = np.repeat(colors[whole], 3 * (points.shape[-2] - 2), axis=0)
        batch = batch_for_shader(shader, "TRIS", content)
    batch.draw(shader)


def _positions(points: Array) -> SingleArray:
    """Vertices (V, 3): the polyline shaders take no plane coordinates."""
    flat = np.zeros((points.size // points.shape[-1], 3), dtype=np.float32)
    flat[:, : points.shape[-1]] = points.reshape(-1, points.shape[-1])
    return flat


def texture(pixels: ArrayLike) -> gpu.types.GPUTexture:
    """Upload a picture to the graphics card; keep the texture, as making one takes time.

    Args:
        pixels: (height, width, 4) red, green, blue, alpha in sRGB, 0 to 1, top row first; the texture's own
            coordinates begin at the bottom.
    """
    rows = np.ascontiguousarray(np.asarray(pixels, dtype=np.float32)[::-1])
    height, width, _ = rows.shape
    data = gpu.types.Buffer("FLOAT", rows.size, rows.ravel())
    return gpu.types.GPUTexture((width, height), format="RGBA8", data=data)


def text(
    words: str,
    x: float,
    y: float,
    color: Color = INK,
    size: float = TEXT_SIZE,
    align: Literal["left", "middle", "right"] = "left",
) -> None:
    """Draw a line of text, outlined so that it reads on any background.

    Args:
        words: The text.
        x: Position of the part of the text that `align` names [region px].
        y: Base line [region px].
        color: Color of the text.
        size: In points, scaled with the user interface.
        align: `left`, `middle` or `right`.
    """
    blf.size(FONT, size * ui_scale())
    blf.color(FONT, *color)
    blf.enable(FONT, blf.SHADOW)
    blf.shadow(FONT, OUTLINED_TEXT, 0.0, 0.0, 0.0, color[3])
    blf.shadow_offset(FONT, 0, 0)
    blf.position(FONT, round(x - ALIGNMENTS[align] * blf.dimensions(FONT, words)[0]), round(y), 0.0)
    blf.draw(FONT, words)
    blf.disable(FONT, blf.SHADOW)
    gpu.state.blend_set("ALPHA")  # blf disables blending, which would make later items opaque


def text_size(words: str, size: float = TEXT_SIZE) -> tuple[float, float]:
    """Width and height of a line of text as `text` draws it [region px]."""
    blf.size(FONT, size * ui_scale())
    width, height = blf.dimensions(FONT, words)
    return float(width), float(height)
