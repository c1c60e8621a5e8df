"""The performer as a stick figure: left limbs solid, right limbs hollow, near ones over far ones."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array, Image
from ..body.kinematics import segment_ends
from ..camera.camera import Camera
from ..feet.natural_extremities import natural_extremities
from ..take.motion import Motion
from .canvas import GRAY, INK, LEFT, PALE, PAPER, RIGHT, WHITE, Canvas, Color, view_axes

Projection = Callable[[Array], tuple[Array, Array]]
"""From world points (N, 3) to canvas points (N, 2) and depths (N,), which grow with the distance."""

HEAD_RADIUS = 0.055  # in statures; the head point is the head's center


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
    extremities = natural_extremities(body, motion.posture, motion.time_s)
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
    return StickFigure(tuple(limbs), by_name["head"], HEAD_RADIUS * body.actor.stature_m)


def draw_figure(
    canvas: Canvas, figure: StickFigure, frame: int, project: Projection, width: float, *, outlined: bool
) -> None:
    """Draw the figure of one frame."""
    parts: list[tuple[float, Limb | None]] = []
    for limb in figure.limbs:
        _, depth = project(limb.points[frame])
        parts.append((float(np.nan_to_num(depth).mean()), limb))
    _, depth = project(figure.head[frame][None])
    parts.append((float(np.nan_to_num(depth)[0]), None))
    for _, part in sorted(parts, key=lambda pair: -pair[0]):
        if part is None:
            _draw_head(canvas, figure, frame, project, width, outlined)
        else:
            points, _ = project(part.points[frame])
            _draw_limb(canvas, points, part.side, width, outlined)


def _draw_limb(canvas: Canvas, points: Array, side: str, width: float, outlined: bool) -> None:
    color = {"L": LEFT, "R": RIGHT}.get(side, INK)
    thickness = width if side else 0.8 * width
    if outlined:
        canvas.line(points, WHITE, thickness + 2.0)
    canvas.line(points, color, thickness)
    if side == "R":
        canvas.line(points, WHITE, 0.4 * thickness)
    for joint in points[:-1] if side else ():
        canvas.disc(joint, 0.85 * width, color)
        if side == "R":
            canvas.disc(joint, 0.45 * width, WHITE)


def _draw_head(
    canvas: Canvas, figure: StickFigure, frame: int, project: Projection, width: float, outlined: bool
) -> None:
    center = figure.head[frame]
    # A step along each axis of space; the longest projection is the radius in any view.
    rim, _ = project(center + figure.head_radius_m * np.vstack([np.eye(3), np.zeros((1, 3))]))
    radius = float(np.linalg.norm(rim[:3] - rim[3], axis=-1).max())
    if not np.isfinite(radius):
        return
    if outlined:
        canvas.ring(rim[3], radius, WHITE, 0.8 * width + 2.0)
    canvas.ring(rim[3], radius, INK, 0.8 * width)


def legend(canvas: Canvas, right: float, y: float) -> None:
    """Draw the legend of left and right limbs, ending at `right`."""
    words: tuple[tuple[str, str, Color], ...] = (("R", "right", RIGHT), ("L", "left", LEFT))
    for side, word, color in words:
        text = f"performer's {word}"
        canvas.text(text, right, y, 9.0, color, "right")
        right -= canvas.text_width(text) + 8.0
        _draw_limb(canvas, np.array([[right - 26.0, y - 4.5], [right, y - 4.5]]), side, 4.0, False)
        right -= 26.0 + 18.0


PADDING = 1.35
"""Side of the square in heights or widths of the largest figure, whose points end at the head's center."""
SMALLEST_SIDE = 0.3
"""Smallest side of the square, of the picture's shorter side: limits the magnification of a tiny figure."""


def squares_around(
    points: Array | Mapping[int, Array], camera: Camera, frames: Sequence[int]
) -> tuple[Array, float]:
    """Centers (K, 2) and common side of squares around the figure in each frame [px].

    They stay inside the picture where they fit.

    Args:
        points: (N, 3) places of the figure by frame index [m].
        camera: The camera.
        frames: Frame indices of the K pictures.
    """
    size = np.array(camera.resolution, dtype=np.float64)
    centers, extents = np.tile(0.5 * size, (len(frames), 1)), np.zeros(len(frames))
    for index, frame in enumerate(frames):
        pixels, _ = camera.project(points[frame], frame)
        seen = pixels[np.isfinite(pixels).all(axis=-1)]
        if len(seen):
            low, high = np.clip(seen.min(axis=0), 0.0, size), np.clip(seen.max(axis=0), 0.0, size)
            centers[index], extents[index] = 0.5 * (low + high), (high - low).max()
    wanted = PADDING * extents.max() if extents.any() else size.max()
    side = float(np.clip(wanted, SMALLEST_SIDE * size.min(), size.max()))
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


SIZE = 256
POSES = 3
EDGE = 14


def thumbnail(motion: Motion) -> Image:
    """Draw three poses of a motion, the earliest at the left, in parallel projection."""
    frames = np.round(np.linspace(0, len(motion.time_s) - 1, 2 * POSES + 1)[1::2]).astype(np.intp)
    figure = stick_figure(motion)
    names = motion.body.skeleton.point_names
    side = np.nanmean(motion.points[:, names.index("hip.L")] - motion.points[:, names.index("hip.R")], axis=0)
    # The performer's left is on the right of the view.
    axes = view_axes(float(np.arctan2(side[1], side[0])) + 0.5, 0.0)
    points = np.concatenate([limb.points for limb in figure.limbs], axis=1)[frames]  # (K, N, 3)
    seen = points @ axes.T
    middle = 0.5 * (seen[..., 0].max(axis=1) + seen[..., 0].min(axis=1))  # (K,)
    floor, top = seen[..., 1].min(), seen[..., 1].max() + figure.head_radius_m
    wide = float(np.ptp(seen[..., 0], axis=1).max())
    column = (SIZE - 2 * EDGE) / POSES
    scale = min((SIZE - 2 * EDGE) / (top - floor), 1.25 * column / wide)
    ground = 0.5 * (SIZE + scale * (top - floor))
    canvas = Canvas(SIZE, SIZE, PAPER)
    canvas.line([[EDGE, ground], [SIZE - EDGE, ground]], GRAY, 1.5)
    for number, frame in enumerate(frames):
        center = EDGE + column * (number + 0.5)

        def project(points: Array, center: float = center, number: int = number) -> tuple[Array, Array]:
            right, upward, away = axes @ points.T
            x, y = center + scale * (right - middle[number]), ground - scale * (upward - floor)
            return np.stack([x, y], axis=-1), away

        draw_figure(canvas, figure, int(frame), project, 5.0, outlined=True)
    return canvas.image()
