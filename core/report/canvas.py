"""An anti-aliased picture to draw on, in pixels with fractions, and the performer as a stick figure on it."""

import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..arrays import Array, Image
from ..body.human import STRONG
from ..body.kinematics import segment_ends
from ..body.posture import UP
from ..camera.camera import Camera
from ..feet.natural_extremities import natural_extremities
from ..numerics.vectors import unit
from ..take.motion import Motion

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


Projection = Callable[[Array], tuple[Array, Array]]  # from the world to pixels (N, 2) and depths (N,)


@dataclass(frozen=True)
class Limb:
    """A line through points of the body, for every frame."""

    side: str  # `L`, `R`, or empty for the trunk
    points: Array  # (F, N, 3) [m]


@dataclass(frozen=True)
class StickFigure:
    """The limbs and the head of a motion's performer."""

    limbs: tuple[Limb, ...]
    head: Array  # (F, 3) center of the head [m]
    head_radius_m: float


def stick_figure(motion: Motion) -> StickFigure:
    """The lines of a motion's performer: arms and legs with hands and feet, hips, shoulders and spine."""
    body, pose = motion.body, motion.body.pose(motion.posture)
    extremities = natural_extremities(body, motion.posture, motion.time_s, hands=motion.hands)
    by_name = dict(zip(body.skeleton.point_names, np.swapaxes(motion.points, 0, 1), strict=True))
    limbs = []
    for side in ("L", "R"):
        for joints, end in ((("shoulder", "elbow", "wrist"), "hand"), (("hip", "knee", "ankle"), "foot")):
            line = [by_name[f"{joint}.{side}"] for joint in joints]
            tip = segment_ends(body, pose, extremities, f"{end}.{side}")[1]
            limbs.append(Limb(side, np.stack([*line, tip], axis=1)))
    hips = 0.5 * (by_name["hip.L"] + by_name["hip.R"])
    shoulders = 0.5 * (by_name["shoulder.L"] + by_name["shoulder.R"])
    waist = body.segment_ends(pose, "chest")[0]
    limbs.append(Limb("", np.stack([hips, waist, shoulders, by_name["head"]], axis=1)))
    limbs.append(Limb("", np.stack([by_name["hip.L"], hips, by_name["hip.R"]], axis=1)))
    limbs.append(Limb("", np.stack([by_name["shoulder.L"], shoulders, by_name["shoulder.R"]], axis=1)))
    # The head's radius in statures; the head point is its center.
    return StickFigure(tuple(limbs), by_name["head"], 0.055 * body.actor.stature_m)


def draw_figure(canvas: Canvas, figure: StickFigure, frame: int, project: Projection, width: float) -> None:
    """Draw the figure of one frame, outlined in white."""
    parts: list[tuple[float, Limb | None]] = []
    for limb in figure.limbs:
        _, depth = project(limb.points[frame])
        parts.append((float(np.nan_to_num(depth).mean()), limb))
    # The head's center and a step from it along each axis of space: the longest is its radius in any view.
    rim, depth = project(figure.head[frame] + figure.head_radius_m * np.vstack([np.zeros(3), np.eye(3)]))
    radius = float(np.linalg.norm(rim[1:] - rim[0], axis=-1).max())
    parts.append((float(np.nan_to_num(depth)[0]), None))
    for _, part in sorted(parts, key=lambda pair: -pair[0]):
        if part is not None:
            points, _ = project(part.points[frame])
            _draw_limb(canvas, points, part.side, width)
        elif np.isfinite(radius):
            canvas.circle(rim[0], radius, WHITE, 0.8 * width + 2.0)
            canvas.circle(rim[0], radius, INK, 0.8 * width)


def _draw_limb(canvas: Canvas, points: Array, side: str, width: float) -> None:
    color = {"L": LEFT, "R": RIGHT}.get(side, INK)
    thickness = width if side else 0.8 * width
    canvas.line(points, WHITE, thickness + 2.0)
    canvas.line(points, color, thickness)
    if side == "R":
        canvas.line(points, WHITE, 0.4 * thickness)
    for joint in points[:-1] if side else ():
        canvas.circle(joint, 0.85 * width, color)
        if side == "R":
            canvas.circle(joint, 0.45 * width, WHITE)


def legend(canvas: Canvas, right: float, y: float) -> None:
    """Draw the legend of left and right limbs, ending at `right`."""
    sides: tuple[tuple[str, str, Color], ...] = (("R", "right", RIGHT), ("L", "left", LEFT))
    for side, word, color in sides:
        text = f"performer's {word}"
        canvas.text(text, right, y, 9.0, color, "right")
        right -= canvas.text_width(text) + 8.0
        _draw_limb(canvas, np.array([[right - 26.0, y - 4.5], [right, y - 4.5]]), side, 4.0)
        right -= 26.0 + 18.0


def squares_around(
    points: Array | Mapping[int, Array], camera: Camera, frames: Sequence[int]
) -> tuple[Array, float]:
    """Centers (K, 2) and side of squares around places (N, 3) [m] by frame, inside where they fit [px]."""
    size = np.array(camera.resolution, dtype=np.float64)
    centers, extents = np.tile(0.5 * size, (len(frames), 1)), np.zeros(len(frames))
    for index, frame in enumerate(frames):
        pixels, _ = camera.project(points[frame], frame)
        seen = pixels[np.isfinite(pixels).all(axis=-1)]
        if len(seen):
            low, high = np.clip(seen.min(axis=0), 0.0, size), np.clip(seen.max(axis=0), 0.0, size)
            centers[index], extents[index] = 0.5 * (low + high), (high - low).max()
    # Room about the largest figure, whose points end at the head's center, but no less than a share of the
    # picture, which limits the magnification of a tiny figure.
    wanted = 1.35 * extents.max() if extents.any() else size.max()
    side = float(np.clip(wanted, 0.3 * size.min(), size.max()))
    half = np.minimum(0.5 * side, 0.5 * size)
    return np.clip(centers, half, size - half), side


def square_of(image: Image, corner: Array, side: float, resolution: tuple[int, int]) -> Image:
    """The square of a frame that may be reduced, padded where it reaches beyond the picture."""
    shrunk = image.shape[1] / resolution[0]
    across = max(round(shrunk * side), 1)
    left, top = (int(value) for value in np.round(shrunk * corner))
    rows = slice(max(top, 0), min(top + across, image.shape[0]))
    columns = slice(max(left, 0), min(left + across, image.shape[1]))
    inside = image[rows, columns]
    above, before = rows.start - top, columns.start - left
    below, behind = across - above - inside.shape[0], across - before - inside.shape[1]
    filled = cv2.copyMakeBorder(inside, above, below, before, behind, cv2.BORDER_CONSTANT, value=PALE)
    return np.asarray(filled, dtype=np.uint8)
