"""A small square picture of a posture for an asset browser."""

import numpy as np

from ..arrays import Image
from ..body.heading import facing_rad
from ..body.kinematics import Body
from ..body.posture import Posture
from .mannequin import View, draw_mannequin, mannequin

SIZE = 256
EDGE = 8
TURN_RAD = np.radians(-35.0)
"""Turn of the view from the front, with the face to the right of the picture."""
TILT_RAD = 0.16
"""Downward tilt of the view, which shows where on the floor the feet are."""
WALL = np.array([250.0, 249.0, 248.0])
FLOOR = np.array([229.0, 225.0, 222.0])
BEHIND_M = 0.45
"""Distance of the wall behind the figure."""


def posture_picture(body: Body, posture: Posture) -> Image:
    """Draw a single posture; the floor is z = 0.

    Returns:
        (256, 256, 3) blue, green, red.
    """
    figure = mannequin(body, posture)
    turn = facing_rad(-posture.rotations[0, :, 1]) + TURN_RAD
    seen = View(turn, TILT_RAD, 1.0, (0.0, 0.0)).project(figure.points)[0]
    floor = View(turn, TILT_RAD, 1.0, (0.0, 0.0)).project(posture.translation * [1.0, 1.0, 0.0])[0][1]
    (left, high), (right, low) = seen.min(axis=0), seen.max(axis=0)
    low = max(low, floor + 0.1)
    scale = (SIZE - 2 * EDGE) / max(low - high, right - left, 1.08 * body.actor.stature_m)
    center = (0.5 * SIZE - scale * 0.5 * (left + right), SIZE - EDGE - scale * low)
    wall = backdrop(SIZE, SIZE, center[1] + scale * floor, scale)
    return draw_mannequin(wall, figure, View(turn, TILT_RAD, scale, center))


def backdrop(height: int, width: int, floor: float, scale: float) -> Image:
    """A floor before a wall.

    Args:
        height: Height of the picture.
        width: Width of the picture.
        floor: Picture row of the floor under the figure.
        scale: Pixels a meter.
    """
    rows = np.arange(height) + 0.5 - (floor - scale * BEHIND_M * np.sin(TILT_RAD))
    share = np.clip(rows + 0.5, 0.0, 1.0)  # of each row, that is floor
    fade = np.clip(rows / (3.0 * scale * BEHIND_M * np.sin(TILT_RAD)), 0.0, 1.0)
    ground = FLOOR + fade[:, None] * 0.6 * (WALL - FLOOR)
    colors = WALL + share[:, None] * (ground - WALL)
    return np.asarray(np.repeat(np.round(colors)[:, None], width, axis=1), dtype=np.uint8)
