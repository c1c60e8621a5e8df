"""The view from the side, which follows the camera, and its grid."""

import numpy as np

from ..arrays import Array
from ..footage.camera import Camera
from ..numerics.vectors import unit
from .canvas import GRAY, PALE, Canvas

UP = np.array([0.0, 0.0, 1.0])


def side_directions(camera: Camera) -> Array:
    """World directions (3, 3) that a view from the side shows to the right, upwards, and away, as rows.

    To the right is the camera's direction made level.
    """
    matrix = camera.matrix_world.reshape(-1, 4, 4)[0]
    level = -matrix[:3, 2] * [1.0, 1.0, 0.0]
    if np.linalg.norm(level) < 0.1:  # looking straight down or up: the picture's upper edge is ahead
        level = matrix[:3, 1] * [1.0, 1.0, 0.0]
    ahead = unit(level)
    return np.stack([ahead, UP, np.cross(UP, ahead)])


def draw_grid(tile: Canvas, step: float, floor: float) -> None:
    """Draw lines every `step` pixels from the middle and from the row `floor`, which is darker."""
    reach = int(max(tile.width, tile.height) / step) + 1
    for number in np.arange(-reach, reach + 1):
        x, y = 0.5 * tile.width + step * number, floor - step * number
        tile.line([[x, 0.0], [x, tile.height]], PALE)
        tile.line([[0.0, y], [tile.width, y]], PALE)
    tile.line([[0.0, floor], [tile.width, floor]], GRAY, 1.6)
