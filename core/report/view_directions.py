"""Directions of the views from the front, the side and above, which follow the camera."""

import numpy as np

from ..arrays import Array
from ..footage.camera import Camera

UP = np.array([0.0, 0.0, 1.0])


def view_directions(view: str, camera: Camera) -> Array:
    """World directions (3, 3) that a view shows to the right, upwards, and away from the eye, as rows.

    Views are `front`, which is the camera's direction made level, `side` and `top`.
    """
    viewing = -camera.matrix_world.reshape(-1, 4, 4)[0, :3, 2]
    level = viewing - (viewing @ UP) * UP
    if np.linalg.norm(level) < 0.1:  # looking straight down or up: the picture's upper edge is ahead
        level = camera.matrix_world.reshape(-1, 4, 4)[0, :3, 1] * [1.0, 1.0, 0.0]
    ahead = level / np.linalg.norm(level)
    right = np.cross(ahead, UP)
    return {
        "front": np.stack([right, UP, ahead]),
        "side": np.stack([ahead, UP, -right]),
        "top": np.stack([right, ahead, -UP]),
    }[view]
