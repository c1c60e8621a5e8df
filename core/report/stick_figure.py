"""The performer as a stick figure: left limbs solid, right limbs hollow, near ones over far ones."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..take.motion import Motion
from .canvas import INK, LEFT, RIGHT, WHITE, Canvas, Color

Projection = Callable[[Array], tuple[Array, Array]]
"""World points (N, 3) to places on the canvas (N, 2) and depths (N,), greater being farther."""

HEAD_RADIUS = 0.055
"""Of the stature; the head point is the head's center."""


@dataclass(frozen=True)
class Limb:
    """A line through places of the body, for every frame."""

    side: str
    """`L`, `R`, or empty for the trunk."""
    places: Array
    """(F, N, 3) [m]."""


@dataclass(frozen=True)
class StickFigure:
    """What of a motion is drawn."""

    limbs: tuple[Limb, ...]
    head: Array
    """(F, 3) center of the head [m]."""
    head_radius_m: float


def stick_figure(motion: Motion) -> StickFigure:
    """The lines of a motion's performer: arms and legs with hands and feet, hips, shoulders and spine."""
    return _figure(motion.body, motion.body.pose(motion.posture), motion.points)


def posed_figure(body: Body, posture: Posture) -> StickFigure:
    """The same of a batch of F postures, each of which counts as a frame."""
    pose = body.pose(posture)
    return _figure(body, pose, body.points(pose))


def _figure(body: Body, pose: Pose, points: Array) -> StickFigure:
    place = dict(zip(body.skeleton.point_names, np.swapaxes(points, 0, 1), strict=True))
    limbs = []
    for side in ("L", "R"):
        for joints, end in ((("shoulder", "elbow", "wrist"), "hand"), (("hip", "knee", "ankle"), "foot")):
            line = [place[f"{joint}.{side}"] for joint in joints]
            limbs.append(Limb(side, np.stack([*line, _tip(body, pose, f"{end}.{side}")], axis=1)))
    hips = 0.5 * (place["hip.L"] + place["hip.R"])
    shoulders = 0.5 * (place["shoulder.L"] + place["shoulder.R"])
    waist = body.segment_ends(pose, "chest")[0]
    limbs.append(Limb("", np.stack([hips, waist, shoulders, place["head"]], axis=1)))
    limbs.append(Limb("", np.stack([place["hip.L"], hips, place["hip.R"]], axis=1)))
    limbs.append(Limb("", np.stack([place["shoulder.L"], shoulders, place["shoulder.R"]], axis=1)))
    return StickFigure(tuple(limbs), place["head"], HEAD_RADIUS * body.actor.stature_m)


def _tip(body: Body, pose: Pose, segment: str) -> Array:
    return body.segment_ends(pose, segment)[1]


def draw_figure(
    canvas: Canvas, figure: StickFigure, frame: int, project: Projection, width: float, *, outlined: bool
) -> None:
    """Draw the figure of one frame.

    Args:
        canvas: Where to.
        figure: The figure.
        frame: Position in the clip.
        project: Takes world points to the canvas.
        width: Thickness of a limb in picture units.
        outlined: Whether a dark edge sets it off from a picture below.
    """
    parts: list[tuple[float, Limb | None]] = []
    for limb in figure.limbs:
        _, depth = project(limb.places[frame])
        parts.append((float(np.nan_to_num(depth).mean()), limb))
    _, depth = project(figure.head[frame][None])
    parts.append((float(np.nan_to_num(depth)[0]), None))
    for _, part in sorted(parts, key=lambda pair: -pair[0]):
        if part is None:
            _draw_head(canvas, figure, frame, project, width, outlined)
        else:
            places, _ = project(part.places[frame])
            _draw_limb(canvas, places, part.side, width, outlined)


def _draw_limb(canvas: Canvas, places: Array, side: str, width: float, outlined: bool) -> None:
    color = {"L": LEFT, "R": RIGHT}.get(side, INK)
    thickness = width if side else 0.8 * width
    if outlined:
        canvas.line(places, WHITE, thickness + 2.0)
    canvas.line(places, color, thickness)
    if side == "R":
        canvas.line(places, WHITE, 0.4 * thickness)
    for joint in places[:-1] if side else ():
        canvas.disc(joint, 0.85 * width, color)
        if side == "R":
            canvas.disc(joint, 0.45 * width, WHITE)


def _draw_head(
    canvas: Canvas, figure: StickFigure, frame: int, project: Projection, width: float, outlined: bool
) -> None:
    center = figure.head[frame]
    # A step in each direction of space, the longest of which is the radius whatever the view.
    rim, _ = project(center + figure.head_radius_m * np.vstack([np.eye(3), np.zeros((1, 3))]))
    radius = float(np.linalg.norm(rim[:3] - rim[3], axis=-1).max())
    if not np.isfinite(radius):
        return
    if outlined:
        canvas.ring(rim[3], radius, WHITE, 0.8 * width + 2.0)
    canvas.ring(rim[3], radius, INK, 0.8 * width)


def legend(canvas: Canvas, right: float, y: float) -> None:
    """Say which limbs are the performer's left and which the right, ending at `right`."""
    words: tuple[tuple[str, str, Color], ...] = (("R", "right", RIGHT), ("L", "left", LEFT))
    for side, word, color in words:
        text = f"performer's {word}"
        canvas.text(text, right, y, 9.0, color, "right")
        right -= canvas.text_width(text) + 8.0
        _draw_limb(canvas, np.array([[right - 26.0, y - 4.5], [right, y - 4.5]]), side, 4.0, False)
        right -= 26.0 + 18.0
