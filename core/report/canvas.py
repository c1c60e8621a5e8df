"""An anti-aliased picture to draw on, in pixels with fractions."""

import unicodedata
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..arrays import Array, Image
from ..body.human import STRONG
from ..body.posture import UP
from ..camera.camera import Camera
from ..numerics.vectors import unit

Color = tuple[int, int, int]  # blue, green, red, 0 to 255

WHITE: Color = (255, 255, 255)
INK: Color = (51, 45, 42)
PAPER: Color = (250, 249, 248)
PALE: Color = (226, 222, 219)
GRAY: Color = (140, 134, 130)
LEFT: Color = STRONG["L"][::-1]
RIGHT: Color = STRONG["R"][::-1]
ACCENT: Color = (115, 158, 0)

SCALE = 2  # supersampling: everything is drawn this much larger and reduced at the end
SUBPIXEL_BITS = 4  # fractional bits of coordinates: OpenCV draws to sixteenths of a pixel
FONT = cv2.FONT_HERSHEY_DUPLEX
LETTER_PX = 21.0  # height of the font's capital letters at scale 1
GRID_M = 0.5  # between the lines of a grid that sizes are read off


class Canvas:
    """A picture of `width` by `height`; y runs down, the origin is the outer corner of the top left pixel."""

    def __init__(self, width: int, height: int, color: Color = WHITE) -> None:
        self.width, self.height = width, height
        self._pixels: Image = np.empty((height * SCALE, width * SCALE, 3), dtype=np.uint8)
        cv2.rectangle(self._pixels, (0, 0), (width * SCALE, height * SCALE), color, cv2.FILLED)

    def image(self) -> Image:
        """The finished picture, (height, width, 3), blue, green, red."""
        reduced = cv2.resize(self._pixels, (self.width, self.height), interpolation=cv2.INTER_AREA)
        return np.asarray(reduced, dtype=np.uint8)

    def paste(self, image: Image, left: int, top: int, width: int, height: int) -> None:
        """Resize a picture to a rectangle of the canvas."""
        size = (width * SCALE, height * SCALE)
        larger = size[0] > image.shape[1]
        interpolation = cv2.INTER_CUBIC if larger else cv2.INTER_AREA
        rows = slice(top * SCALE, top * SCALE + size[1])
        self._pixels[rows, left * SCALE : left * SCALE + size[0]] = cv2.resize(
            image, size, interpolation=interpolation
        )

    def line(self, points: ArrayLike, color: Color, thickness: float = 1.0, *, closed: bool = False) -> None:
        """Draw a line through points (N, 2); it is broken where a point is not finite."""
        vertices = np.asarray(points, dtype=np.float64)
        finite = np.isfinite(vertices).all(axis=-1)
        for run in np.split(np.arange(len(vertices)), np.flatnonzero(np.diff(finite)) + 1):
            if finite[run[0]] and len(run) > 1:
                whole, width = closed and len(run) == len(vertices), max(1, round(thickness * SCALE))
                lines = [_fixed(vertices[run])]
                cv2.polylines(self._pixels, lines, whole, color, width, cv2.LINE_AA, SUBPIXEL_BITS)

    def circle(self, center: ArrayLike, radius: float, color: Color, thickness: float | None = None) -> None:
        """Draw a circle as a line of a thickness, by default filled; none where its center is not finite."""
        point = np.asarray(center, dtype=np.float64)
        if np.isfinite(point).all():
            x, y = _fixed(point[None])[0, 0]
            size = round(radius * SCALE * 2**SUBPIXEL_BITS)
            width = cv2.FILLED if thickness is None else max(1, round(thickness * SCALE))
            cv2.circle(self._pixels, (int(x), int(y)), size, color, width, cv2.LINE_AA, SUBPIXEL_BITS)

    def box(self, left: float, top: float, right: float, bottom: float, color: Color) -> None:
        """Fill a rectangle."""
        self.polygon([[left, top], [right, top], [right, bottom], [left, bottom]], color)

    def polygon(self, corners: ArrayLike, color: Color) -> None:
        """Fill a convex polygon of corners (N, 2)."""
        cv2.fillConvexPoly(
            self._pixels, _fixed(np.asarray(corners, dtype=np.float64)), color, cv2.LINE_AA, SUBPIXEL_BITS
        )

    def text(
        self, words: str, x: float, y: float, size: float = 9.0, color: Color = INK, align: str = "left"
    ) -> None:
        """Write ASCII text with its baseline at `y`; `size` is the height of capital letters.

        `align` says which part of the text is at `x`: its `left`, `middle` or `right`.
        """
        x -= self.text_width(words, size) * {"left": 0.0, "middle": 0.5, "right": 1.0}[align]
        origin = (round(x * SCALE), round(y * SCALE))
        weight = max(1, round(size * SCALE / 14.0))
        cv2.putText(self._pixels, words, origin, FONT, size * SCALE / LETTER_PX, color, weight, cv2.LINE_AA)

    @staticmethod
    def text_width(words: str, size: float = 9.0) -> float:
        """Width of a text as `text` writes it."""
        (width, _), _ = cv2.getTextSize(words, FONT, size * SCALE / LETTER_PX, 1)
        return float(width) / SCALE


def write_png(path: str, image: Image) -> None:
    """Write a picture as PNG; unlike OpenCV's own writer to any path on any system."""
    done, data = cv2.imencode(".png", image, [cv2.IMWRITE_PNG_COMPRESSION, 4])
    if not done:
        raise OSError(f"{path}: the picture cannot be encoded")
    with open(path, "wb") as file:
        file.write(data.tobytes())


def _fixed(points: Array) -> NDArray[np.int32]:
    """Points (N, 2) in OpenCV's fixed-point form: (N, 1, 2) in sixteenths, pixel centers at integers."""
    limit = 2.0**14  # far outside every picture; more would overflow
    clipped = np.clip(points * SCALE - 0.5, -limit, limit)
    return np.round(clipped * 2**SUBPIXEL_BITS).astype(np.int32)[:, None]


def truncated(text: str, width: float = np.inf, size: float = 9.0) -> str:
    """The text in ASCII, which the font has, truncated to a `width` in letters of a `size`."""
    text = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    if Canvas.text_width(text, size) <= width:
        return text
    while text and Canvas.text_width(f"{text}...", size) > width:
        text = text[:-1]
    return f"{text.rstrip()}..."


@dataclass(frozen=True, eq=False)
class View:
    """A parallel projection."""

    axes: Array  # (3, 3) world directions that it shows to the right, upwards, and away from the eye, as rows
    scale: float  # pixels a meter
    center: tuple[float, float]  # the origin in the picture: pixels to the right and down
    origin: Array | float = 0.0  # (3,) in the world [m]

    def project(self, points: Array) -> tuple[Array, Array]:
        """Pixels (..., 2) and depths (...,) [m] of world points (..., 3)."""
        seen = (points - self.origin) @ self.axes.T
        return self.center + self.scale * seen[..., :2] * [1.0, -1.0], seen[..., 2]


def view_axes(turn_rad: float, tilt_rad: float) -> Array:
    """Axes of a view: turned by 0 it sees a performer who faces -Y from the front, by π/2 from their left."""
    right = np.array([np.cos(turn_rad), np.sin(turn_rad), 0.0])
    level = np.array([-right[1], right[0], 0.0])
    away = np.cos(tilt_rad) * level - np.sin(tilt_rad) * UP
    return np.stack([right, np.cross(right, away), away])


def side_axes(camera: Camera) -> Array:
    """Axes of a view from the side, which shows the camera's direction, made level, to the right."""
    matrix = camera.matrix_world.reshape(-1, 4, 4)[0]
    level = -matrix[:3, 2] * [1.0, 1.0, 0.0]
    if np.linalg.norm(level) < 0.1:  # looking straight down or up: the picture's upper edge is ahead
        level = matrix[:3, 1] * [1.0, 1.0, 0.0]
    ahead = unit(level)
    return np.stack([ahead, UP, np.cross(UP, ahead)])


def draw_grid(tile: Canvas, scale: float, floor: float) -> None:
    """Draw a grid of `scale` pixels a meter from the middle and from the row `floor`, which is darker."""
    step = scale * GRID_M
    reach = int(max(tile.width, tile.height) / step) + 1
    for number in np.arange(-reach, reach + 1):
        x, y = 0.5 * tile.width + step * number, floor - step * number
        tile.line([[x, 0.0], [x, tile.height]], PALE)
        tile.line([[0.0, y], [tile.width, y]], PALE)
    tile.line([[0.0, floor], [tile.width, floor]], GRAY, 1.6)
