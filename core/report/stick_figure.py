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
from .canvas import GRAY, INK, LEFT, PALE, PAPER, RIGHT, WHITE, Canvas, Color, View, view_axes

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


def draw_figure(
    canvas: Canvas, figure: StickFigure, frame: int, project: Projection, width: float, *, outlined: bool
) -> None:
    """Draw the figure of one frame."""
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
            _draw_limb(canvas, points, part.side, width, outlined)
        elif np.isfinite(radius):
            if outlined:
                canvas.circle(rim[0], radius, WHITE, 0.8 * width + 2.0)
            canvas.circle(rim[0], radius, INK, 0.8 * width)


def _draw_limb(canvas: Canvas, points: Array, side: str, width: float, outlined: bool) -> None:
    color = {"L": LEFT, "R": RIGHT}.get(side, INK)
    thickness = width if side else 0.8 * width
    if outlined:
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
        _draw_limb(canvas, np.array([[right - 26.0, y - 4.5], [right, y - 4.5]]), side, 4.0, False)
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


def thumbnail(motion: Motion) -> Image:
    """Draw three poses of a motion, the earliest at the left, in parallel projection."""
    side_px, edge, poses = 256, 14, 3
    frames = np.round(np.linspace(0, len(motion.time_s) - 1, 2 * poses + 1)[1::2]).astype(np.intp)
    figure = stick_figure(motion)
    names = motion.body.skeleton.point_names
    side = np.nanmean(motion.points[:, names.index("hip.L")] - motion.points[:, names.index("hip.R")], axis=0)
    # The performer's left is on the right of the view.
    axes = view_axes(float(np.arctan2(side[1], side[0])) + 0.5, 0.0)
    seen = np.concatenate([limb.points for limb in figure.limbs], axis=1)[frames] @ axes.T  # (K, N, 3)
    middle = 0.5 * (seen[..., 0].max(axis=1) + seen[..., 0].min(axis=1))  # (K,)
    floor, top = seen[..., 1].min(), seen[..., 1].max() + figure.head_radius_m
    column = (side_px - 2 * edge) / poses
    wide = float(np.ptp(seen[..., 0], axis=1).max())
    scale = min((side_px - 2 * edge) / (top - floor), 1.25 * column / wide)
    ground = 0.5 * (side_px + scale * (top - floor))
    canvas = Canvas(side_px, side_px, PAPER)
    canvas.line([[edge, ground], [side_px - edge, ground]], GRAY, 1.5)
    for number, frame in enumerate(frames):
        center = edge + column * (number + 0.5) - scale * middle[number]
        view = View(axes, scale, (center, ground + scale * floor))
        draw_figure(canvas, figure, int(frame), view.project, 5.0, outlined=True)
    return canvas.image()
