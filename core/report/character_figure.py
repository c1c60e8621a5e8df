"""A character as shaded triangles, drawn through any projection."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from ..numerics.vectors import unit
from .canvas import Canvas, Color
from .stick_figure import Projection

LIGHT = np.array([0.35, -0.5, 0.8])
"""Direction to the light in the world."""
DARKEST = 0.45
SKIN: Color = (196, 190, 186)


@dataclass(frozen=True, eq=False)
class CharacterFigure:
    """A character in one frame."""

    points: Array
    """(N, 3) corners of the triangles in the world [m]."""
    triangles: IndexArray
    """(T, 3) rows of `points`, counterclockwise seen from outside."""
    colors: Array
    """(T, 3) blue, green, red, 0 to 255."""


def draw_character(canvas: Canvas, figure: CharacterFigure, project: Projection) -> None:
    """Draw the triangles that face the eye, the farthest first."""
    if not len(figure.triangles):
        return
    pixels, depth = project(figure.points)
    corners = pixels[figure.triangles]  # (T, 3, 2)
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    # y runs down in a picture: what is counterclockwise from outside turns the other way there.
    facing = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0] < 0.0
    away = depth[figure.triangles].mean(axis=1)
    shown = np.flatnonzero(facing & np.isfinite(corners).all(axis=(1, 2)) & np.isfinite(away))
    world = figure.points[figure.triangles[shown]]
    normal = np.cross(world[:, 1] - world[:, 0], world[:, 2] - world[:, 0])
    lit = unit(normal) @ unit(LIGHT)
    shaded = figure.colors[shown] * (DARKEST + (1.0 - DARKEST) * (0.5 + 0.5 * lit))[:, None]
    for row in np.argsort(-away[shown], kind="stable"):
        blue, green, red = (int(value) for value in np.clip(shaded[row], 0.0, 255.0))
        canvas.polygon(corners[shown[row]], (blue, green, red))
