"""What overlays draw: lines, polygons, textures, text, items of these, and their style; Blender 4.5 to 5.2.

For draw functions of `registry`, which has enabled blending. Colors are red, green, blue and alpha in sRGB,
0 to 1, as users pick them. Shaders are made at the first call: without a window Blender has none.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import ClassVar, Literal

import blf
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from numpy.typing import ArrayLike

from ...core.arrays import Array
from ...core.body.human import LIGHT, side_of
from ..shell.footage_view import ui_scale
from .figures import triangles

Color = tuple[float, float, float, float]

HALO: Color = (0.0, 0.0, 0.0, 0.75)  # dark edge that sets lines off from footage of any brightness
INK: Color = (1.0, 1.0, 1.0, 1.0)
FONT = 0
TEXT_SIZE = 11.0
ALIGNMENTS = {"left": 0.0, "middle": 0.5, "right": 1.0}


def faded(color: Sequence[float], opacity: float) -> Color:
    """A color of three or four numbers with its alpha multiplied by `opacity`."""
    red, green, blue, *alpha = color
    return (red, green, blue, (alpha[0] if alpha else 1.0) * opacity)


def texture(pixels: ArrayLike) -> gpu.types.GPUTexture:
    """Upload a picture (height, width, 4) of red, green, blue, alpha in sRGB, 0 to 1, top row first."""
    rows = np.ascontiguousarray(np.asarray(pixels, dtype=np.float32)[::-1])
    height, width, _ = rows.shape
    data = gpu.types.Buffer("FLOAT", rows.size, rows.ravel())
    return gpu.types.GPUTexture((width, height), format="RGBA8", data=data)


def text_size(words: str, size: float = TEXT_SIZE) -> tuple[float, float]:
    """Width and height of a line of text as `text` draws it [region px]."""
    blf.size(FONT, size * ui_scale())
    width, height = blf.dimensions(FONT, words)
    return float(width), float(height)


SIDES: Mapping[str, Color] = {
    side: (red / 255.0, green / 255.0, blue / 255.0, 1.0) for side, (red, green, blue) in LIGHT.items()
}
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


def _draw(kind: str, corners: Array, color: ArrayLike, **uniforms: ArrayLike) -> None:
    """Draw lines or triangles (N, K, 2) of one color (4,), or of N colors (N, 4)."""
    colors = np.asarray(color, dtype=np.float32)
    points = np.zeros((corners.size // 2, 3), dtype=np.float32)  # polylines take no plane ones
    points[:, :2] = corners.reshape(-1, 2)
    contents, look = {"pos": points}, "UNIFORM_COLOR"
    if colors.ndim > 1:
        contents["color"], look = np.repeat(colors, len(points) // len(colors), axis=0), "SMOOTH_COLOR"
    else:
        uniforms["color"] = colors.tolist()
    shader = gpu.shader.from_builtin(f"POLYLINE_{look}" if kind == "LINES" else look)
    batch = batch_for_shader(shader, kind, contents)
    for name, value in uniforms.items():
        shader.uniform_float(name, value)
    batch.draw(shader)


@dataclass(frozen=True, eq=False)
class Stroke:
    """Straight lines."""

    segments: Array  # (S, 2, 2) region pixels
    color: ArrayLike  # (4,) for all, or (S, 4)
    width: float = 1.5
    halo: float = 0.0  # opacity of a dark edge on both sides

    def draw(self) -> None:
        """Draw the edges, then the lines."""
        edges = [(faded(HALO, self.halo), self.width + 2.0 * 1.25)] if self.halo > 0.0 else []
        for color, width in [*edges, (self.color, self.width)] if len(self.segments) else []:
            size = gpu.state.viewport_get()[2:]
            _draw("LINES", self.segments, color, viewportSize=size, lineWidth=width * ui_scale())


@dataclass(frozen=True, eq=False)
class Fill:
    """Filled convex polygons."""

    corners: Array  # (N, K, 2) region pixels
    color: ArrayLike  # (4,) for all, or (N, 4)

    def draw(self) -> None:
        """Draw those that are finite."""
        whole, colors = np.isfinite(self.corners).all(axis=(-2, -1)), np.asarray(self.color)
        if whole.any():
            _draw("TRIS", triangles(self.corners[whole]), colors[whole] if colors.ndim > 1 else colors)


@dataclass(frozen=True)
class Label:
    """A line of text; `x` is the position of the part that `align` names, `y` the base line [region px]."""

    words: str
    x: float
    y: float
    color: Color = INK
    align: Literal["left", "middle", "right"] = "left"
    size: float = TEXT_SIZE  # in points, scaled with the user interface

    def draw(self) -> None:
        """Draw it, outlined so that it reads on any background."""
        width, _ = text_size(self.words, self.size)
        blf.color(FONT, *self.color)
        blf.enable(FONT, blf.SHADOW)
        blf.shadow(FONT, 6, 0.0, 0.0, 0.0, self.color[3])
        blf.shadow_offset(FONT, 0, 0)
        blf.position(FONT, round(self.x - ALIGNMENTS[self.align] * width), round(self.y), 0.0)
        blf.draw(FONT, self.words)
        blf.disable(FONT, blf.SHADOW)
        gpu.state.blend_set("ALPHA")  # blf disables blending, which would make later items opaque


@dataclass(frozen=True, eq=False)
class Picture:
    """A texture, cut into triangles."""

    texture: gpu.types.GPUTexture
    corners: Array  # (N, 3, 2) region pixels
    shares: Array  # (N, 3, 2) the same in the texture: of its width from the left, of its height from the top

    def draw(self) -> None:
        """Draw it as it is."""
        points = np.zeros((self.corners.size // 2, 3), dtype=np.float32)
        points[:, :2] = self.corners.reshape(-1, 2)
        # Textures begin at the bottom.
        ends = (self.shares.reshape(-1, 2) * [1.0, -1.0] + [0.0, 1.0]).astype(np.float32)
        shader = gpu.shader.from_builtin("IMAGE_COLOR")
        batch = batch_for_shader(shader, "TRIS", {"pos": points, "texCoord": ends})
        shader.uniform_sampler("image", self.texture)
        shader.uniform_float("color", (1.0, 1.0, 1.0, 1.0))
        batch.draw(shader)


Item = Stroke | Fill | Label | Picture


def merged(items: Iterable[Item]) -> list[Item]:
    """Items to draw, neighbors of one thickness or count of corners as one: a draw call takes time."""
    done: list[Item] = []
    for _, group in groupby(items, key=_kind):
        first, *more = group
        if not more or isinstance(first, Label | Picture):
            done += [first, *more]
            continue
        field = "segments" if isinstance(first, Stroke) else "corners"
        parts = [(getattr(item, field), getattr(item, "color", None)) for item in (first, *more)]
        colors = [np.broadcast_to(np.asarray(color, dtype=np.float64), (len(at), 4)) for at, color in parts]
        together = {field: np.concatenate([at for at, _ in parts]), "color": np.concatenate(colors)}
        done.append(replace(first, **together))
    return done


def _kind(item: Item) -> tuple[object, ...]:
    if isinstance(item, Stroke):
        return ("stroke", item.width, item.halo)
    return ("fill", item.corners.shape[-2]) if isinstance(item, Fill) else (type(item).__name__,)
