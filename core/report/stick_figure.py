"""The performer as a stick figure: left limbs solid, right limbs hollow, near ones over far ones."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.extremities import segment_ends
from ..finish.natural_extremities import natural_extremities
from ..take.motion import Motion
from .canvas import INK, LEFT, RIGHT, WHITE, Canvas, Color

Projection = Callable[[Array], tuple[Array, Array]]
"""From world points (N, 3) to canvas points (N, 2) and depths (N,), which grow with the distance."""

HEAD_RADIUS = 0.055
"""In statures; the head point is the head's center."""


@dataclass(frozen=True)
class Limb:
    """A line through points of the body, for every frame."""

    side: str
    """`L`, `R`, or empty for the trunk."""
    points: Array
    """(F, N, 3) [m]."""


@dataclass(frozen=True)
class StickFigure:
    """The limbs and the head of a motion's performer."""

    limbs: tuple[Limb, ...]
    head: Array
    """(F, 3) center of the head [m]."""
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
    """Draw the figure of one frame.

    Args:
        canvas: The canvas to draw on.
        figure: The figure.
        frame: Frame index in the clip.
        project: Projection of world points to the canvas.
        width: Thickness of a limb [px].
        outlined: Whether a white edge sets it off from the picture below.
    """
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
