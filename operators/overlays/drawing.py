"""What overlays draw: lines, polygons, textures, text, items of these, and their style; Blender 4.5 to 5.2.

For draw functions of `registry`, which has enabled blending. Colors are red, green, blue and alpha in sRGB,
0 to 1, as users pick them. Shaders are made at the first call: without a window Blender has none.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import ClassVar, Literal

import blf
import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from numpy.typing import ArrayLike

from ...core.arrays import Array, SingleArray
from ...core.body.human import LIGHT, Rgb, side_of
from .figures import triangles

Color = tuple[float, float, float, float]

HALO: Color = (0.0, 0.0, 0.0, 0.75)  # dark edge that sets lines off from footage of any brightness
INK: Color = (1.0, 1.0, 1.0, 1.0)
FONT = 0
TEXT_SIZE = 11.0
ALIGNMENTS = {"left": 0.0, "middle": 0.5, "right": 1.0}


def ui_scale() -> float:
    """Screen pixels for each unscaled pixel: resolution scale and high-density screens."""
    return float(bpy.context.preferences.system.ui_scale) or 1.0  # 0 before there is a window


def faded(color: Sequence[float], opacity: float) -> Color:
    """A color of three or four numbers with its alpha multiplied by `opacity`."""
    red, green, blue, *alpha = color
    return (red, green, blue, (alpha[0] if alpha else 1.0) * opacity)


def lines(segments: Array, color: ArrayLike, width: float = 1.5, halo: float = 0.0) -> None:
    """Draw straight segments (S, 2, 2) in region pixels, or (S, 2, 3) in space; colors are (4,) or (S, 4).

    `halo` is the opacity of a dark edge on both sides.
    """
    if not len(segments):
        return
    if halo > 0.0:
        _polyline(segments, faded(HALO, halo), width + 2.0 * 1.25)
    _polyline(segments, color, width)


def _polyline(segments: Array, color: ArrayLike, width: float) -> None:
    colors = np.asarray(color, dtype=np.float32)
    kind = "POLYLINE_SMOOTH_COLOR" if colors.ndim > 1 else "POLYLINE_UNIFORM_COLOR"
    shader = gpu.shader.from_builtin(kind)
    each = np.repeat(colors, 2, axis=0) if colors.ndim > 1 else colors
    batch = _batch(shader, "LINES", segments, each)
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width * ui_scale())
    batch.draw(shader)


def polygons(corners: ArrayLike, color: ArrayLike) -> None:
    """Fill convex polygons (N, K, D), without those that are not finite; colors are (4,) or (N, 4)."""
    points = np.asarray(corners, dtype=np.float64)
    colors = np.asarray(color, dtype=np.float32)
    whole = np.isfinite(points).all(axis=(-2, -1))
    if not whole.any():
        return
    if colors.ndim > 1:
        colors = np.repeat(colors[whole], 3 * (points.shape[-2] - 2), axis=0)
    shader = gpu.shader.from_builtin("SMOOTH_COLOR" if colors.ndim > 1 else "UNIFORM_COLOR")
    _batch(shader, "TRIS", triangles(points[whole]), colors).draw(shader)


def _batch(shader: gpu.types.GPUShader, kind: str, points: Array, colors: SingleArray) -> gpu.types.GPUBatch:
    """Points (..., D) with one color (4,), or one each, as a batch of a shader that is now in use."""
    flat = np.zeros((points.size // points.shape[-1], 3), dtype=np.float32)  # polylines take no plane ones
    flat[:, : points.shape[-1]] = points.reshape(-1, points.shape[-1])
    batch = batch_for_shader(shader, kind, {"pos": flat} | ({"color": colors} if colors.ndim > 1 else {}))
    if colors.ndim == 1:
        shader.uniform_float("color", tuple(colors.tolist()))
    return batch


def texture(pixels: ArrayLike) -> gpu.types.GPUTexture:
    """Upload a picture (height, width, 4) of red, green, blue, alpha in sRGB, 0 to 1, top row first.

    Keep the texture, as making one takes time; its own coordinates begin at the bottom.
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

    `x` is the position of the part of it that `align` names, `y` the base line [region px]; `size` is in
    points, scaled with the user interface.
    """
    blf.size(FONT, size * ui_scale())
    blf.color(FONT, *color)
    blf.enable(FONT, blf.SHADOW)
    blf.shadow(FONT, 6, 0.0, 0.0, 0.0, color[3])
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


# --- Style of the overlays


def _opaque(rgb: Rgb) -> Color:
    red, green, blue = (level / 255.0 for level in rgb)
    return (red, green, blue, 1.0)


SIDES: Mapping[str, Color] = {side: _opaque(rgb) for side, rgb in LIGHT.items()}
LEFT, RIGHT, MIDDLE = SIDES["L"], SIDES["R"], SIDES[""]
"""Colors of the performer's sides, and of what has none."""
CORE: Color = (0.08, 0.08, 0.08, 1.0)  # color of the core of a hollow line
SOURCES: tuple[Color, ...] = (
    (0.90, 0.55, 0.78, 1.0),
    (0.94, 0.89, 0.26, 1.0),
    (0.20, 0.80, 0.62, 1.0),
    (0.72, 0.62, 0.98, 1.0),
)
"""Colors of keypoints by their source: purple, yellow, green and violet, none of them a side's."""
THROWN_OUT: Color = (1.0, 0.25, 0.2, 1.0)  # color of keypoints that are not believed
CANDIDATE_COLORS = 8
"""Colors of collections that Blender's themes have, with an icon each: those of a frame's candidates."""
GHOST = 0.6  # opacity of figures that are only offered
METER, SMALLEST = 160.0, 0.35
"""Size of a meter below which a body's marks get smaller [px], and the smallest share of their size."""
TALL_M = 1.7  # height of a figure by which marks get smaller where it is small [m]
UNCERTAIN_M = 0.05
"""Standard deviation above which a point is drawn as a ring within a circle of that size [m]."""
PATH_POINTS = ("wrist.L", "wrist.R", "ankle.L", "ankle.R")
PATH_FRAMES = 15  # frames of a path before the current one, and after it


@dataclass(frozen=True)
class Style:
    """The animator's opacity, and the scales of screen and body."""

    width: ClassVar[float] = 1.5  # thickness of lines [px]
    limb: ClassVar[float] = 2.4  # thickness of limbs, relative to that
    core: ClassVar[float] = 0.45  # thickness of a hollow line's core, relative to the line's
    dash: ClassVar[float] = 6.0  # [px]
    gap: ClassVar[float] = 4.0  # [px]
    joint: ClassVar[float] = 3.5  # radius [px]
    dot: ClassVar[float] = 1.4  # radius [px]
    diamond: ClassVar[float] = 5.0  # radius [px]
    opacity: float
    scale: float  # screen pixels for each unscaled pixel
    body_scale: float = 1.0  # scale of the body's marks, below 1 for a distant body

    def color(self, color: Color | tuple[float, float, float]) -> Color:
        """A color with the chosen opacity."""
        return faded(color, self.opacity)

    def size(self, plain: float) -> float:
        """A size of the body's marks [region px]."""
        return plain * self.body_scale * self.scale

    @property
    def halo(self) -> float:
        """Opacity of lines' dark edges."""
        return 0.9 * self.opacity


def body_scale(pixels_per_meter: Array, scale: float) -> float:
    """Scale of a body's marks from the size of a meter at each of its points (N,) [region px]."""
    seen = pixels_per_meter[np.isfinite(pixels_per_meter)]
    meter = float(np.median(seen)) / scale if len(seen) else METER
    return float(np.clip(meter / METER, SMALLEST, 1.0))


def candidate_icon(index: int) -> str:
    """Icon in a candidate's color."""
    return f"COLLECTION_COLOR_{index % CANDIDATE_COLORS + 1:02d}"


def side_color(name: str) -> Color:
    """The color of a point by the side of the body in its name."""
    return SIDES[side_of(name)]


def paler(color: tuple[float, float, float]) -> tuple[float, float, float]:
    """A color nearer to white."""
    red, green, blue = (0.5 + (1.0 - 0.5) * np.asarray(color, dtype=np.float64)).tolist()
    return (red, green, blue)


@dataclass(frozen=True, eq=False)
class Stroke:
    """Straight lines."""

    segments: Array  # (S, 2, 2) region pixels
    color: ArrayLike  # (4,) for all, or (S, 4)
    width: float
    halo: float = 0.0  # opacity of the dark edge


@dataclass(frozen=True, eq=False)
class Fill:
    """Filled convex polygons."""

    corners: Array  # (N, K, 2) region pixels
    color: ArrayLike  # (4,) for all, or (N, 4)


@dataclass(frozen=True)
class Label:
    """A line of text; `x` is the position of the part that `align` names, `y` the base line [region px]."""

    words: str
    x: float
    y: float
    color: Color = INK
    align: Literal["left", "middle", "right"] = "left"
    size: float = TEXT_SIZE  # in points, scaled with the user interface


@dataclass(frozen=True, eq=False)
class Picture:
    """A texture, cut into triangles."""

    texture: gpu.types.GPUTexture
    corners: Array  # (N, 3, 2) region pixels
    shares: Array  # (N, 3, 2) the same in the texture: of its width from the left, of its height from the top


Item = Stroke | Fill | Label | Picture


def paint(items: Iterable[Item]) -> None:
    """Draw all items, the first at the bottom; alike neighbors in one draw call."""
    for item in merged(items):
        if isinstance(item, Stroke):
            lines(item.segments, item.color, item.width, item.halo)
        elif isinstance(item, Fill):
            polygons(item.corners, item.color)
        elif isinstance(item, Picture):
            _draw_picture(item)
        else:
            text(item.words, item.x, item.y, item.color, item.size, item.align)


def _draw_picture(picture: Picture) -> None:
    vertices = np.zeros((picture.corners.size // 2, 3), dtype=np.float32)
    vertices[:, :2] = picture.corners.reshape(-1, 2)
    # Textures begin at the bottom.
    ends = (picture.shares.reshape(-1, 2) * [1.0, -1.0] + [0.0, 1.0]).astype(np.float32)
    shader = gpu.shader.from_builtin("IMAGE_COLOR")
    batch = batch_for_shader(shader, "TRIS", {"pos": vertices, "texCoord": ends})
    shader.uniform_sampler("image", picture.texture)
    shader.uniform_float("color", (1.0, 1.0, 1.0, 1.0))
    batch.draw(shader)


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
    return ("fill", item.corners.shape[-2]) if isinstance(item, Fill) else (type(item).__name__,)


def _joined(parts: list[tuple[Array, ArrayLike]]) -> tuple[Array, Array]:
    """Concatenated points, and a color for each."""
    points = np.concatenate([part for part, _ in parts])
    colors = [np.broadcast_to(np.asarray(color, dtype=np.float64), (len(part), 4)) for part, color in parts]
    return points, np.concatenate(colors)
