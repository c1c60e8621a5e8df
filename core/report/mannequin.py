"""A posture as a shaded body in parallel projection, with a shadow on the floor."""

from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array, Image
from ..body.body_volume import Piece, body_pieces, ring_quads
from ..body.extremities import Extremities, segment_turn
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.side_colors import STRONG
from ..finish.foot_pitch import Shins, Soles
from ..finish.foot_turns import feet_on_floor
from .canvas import Canvas
from .character_figure import CharacterFigure, draw_character

SIDES_OF_RING, BANDS_OF_CAP, BANDS_OF_SHAFT = 16, 4, 5
TRUNK = (186, 182, 180)
BAND = (235, 232, 230)
"""Color of a ring around each right limb, which marks it for color-blind eyes too."""
FLOOR_M = 0.0
SHADOW, SOFTNESS_M = 0.32, 0.03
"""Darkness of the shadow, and its blur."""


@dataclass(frozen=True)
class View:
    """Direction of view, scale and origin of a parallel projection."""

    turn_rad: float
    """Turn of the eye around the world's Z: at 0 it sees a performer who faces -Y from the front, at π/2 from
    their left."""
    tilt_rad: float
    """Downward tilt of the view."""
    scale: float
    """Pixels a meter."""
    center: tuple[float, float]
    """The world's origin in the picture: pixels to the right and down."""

    def project(self, points: Array) -> tuple[Array, Array]:
        """Pixels (..., 2) and depths (...,) [m] of world points (..., 3)."""
        seen = points @ view_axes(self.turn_rad, self.tilt_rad).T
        return self.center + self.scale * seen[..., :2] * [1.0, -1.0], seen[..., 2]


def view_axes(turn_rad: float, tilt_rad: float) -> Array:
    """World directions (3, 3) that a view shows to the right, upwards, and away from the eye, as rows."""
    right = np.array([np.cos(turn_rad), np.sin(turn_rad), 0.0])
    level = np.array([-right[1], right[0], 0.0])
    away = np.cos(tilt_rad) * level - np.sin(tilt_rad) * np.array([0.0, 0.0, 1.0])
    return np.stack([right, np.cross(right, away), away])


def draw_mannequin(image: Image, figure: CharacterFigure, view: View) -> Image:
    """The picture (height, width, 3) with a figure, whose shadow falls on the floor z = 0."""
    height, width = image.shape[:2]
    shadow = np.zeros((height, width), dtype=np.float32)
    fallen = np.clip(view.project(figure.points * [1.0, 1.0, 0.0])[0], -1e4, 1e4).round().astype(np.int32)
    for corners in fallen[figure.triangles]:
        cv2.fillConvexPoly(shadow, corners, (1.0,))
    shadow = np.asarray(cv2.GaussianBlur(shadow, (0, 0), SOFTNESS_M * view.scale))
    canvas = Canvas(width, height)
    canvas.paste((image * (1.0 - SHADOW * shadow[..., None])).astype(np.uint8), 0, 0, width, height)
    draw_character(canvas, figure, view.project)
    return canvas.image()


def mannequin(body: Body, posture: Posture) -> CharacterFigure:
    """The body in a single posture, with feet turned where the rigid ones would go below the floor z = 0."""
    pose = body.pose(Posture.stack([posture]))
    feet = Extremities(feet_on_floor(Shins.of(body, pose), Soles.of(body), FLOOR_M))
    points, triangles, colors = [], [], []
    quads = ring_quads(2 * BANDS_OF_CAP + BANDS_OF_SHAFT + 1, SIDES_OF_RING)
    for piece in _pieces(body):
        foot = piece.segment.startswith("foot")
        turn = segment_turn(body, pose, feet, piece.segment)[0] if foot else pose.rotation[0, piece.joint]
        rings = piece.rings(SIDES_OF_RING, BANDS_OF_CAP, BANDS_OF_SHAFT).reshape(-1, 3)
        if foot:
            rings[:, 2] = np.maximum(rings[:, 2], piece.end[2])  # a flat sole
        points.append(pose.place(piece.joint, piece.start)[0] + (rings - piece.start) @ turn.T)
        corners = quads.reshape(-1, 4) + sum(map(len, points[:-1]))
        triangles += [corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]]
        side = piece.segment[-1]
        color = np.tile(np.array(STRONG[side][::-1] if side in STRONG else TRUNK), (*quads.shape[:2], 1))
        if side == "R":
            color[BANDS_OF_CAP + BANDS_OF_SHAFT // 2] = BAND
        colors += [color.reshape(-1, 3)] * 2
    return CharacterFigure(np.concatenate(points), np.concatenate(triangles), np.concatenate(colors))


def _pieces(body: Body) -> tuple[Piece, ...]:
    """The body's volume and a nose, by which one sees where the face is."""
    pieces = body_pieces(body)
    head = next(piece for piece in pieces if piece.segment == "head")
    middle = head.start + 0.65 * (head.end - head.start)
    length, width = 1.3 * head.half_widths[1, 1], 0.2 * head.half_widths[1, 0]
    widths = np.full((2, 2), width)
    up = (head.end - head.start) / np.linalg.norm(head.end - head.start)
    return *pieces, Piece(
        "nose", head.joint, middle, middle - length * head.sagittal, head.lateral, up, widths
    )
