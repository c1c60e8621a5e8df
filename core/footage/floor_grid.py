"""The floor as a grid of meters in the picture, by which people judge a camera."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .camera import Camera
from .camera_placement import heading_rad

REACH_M = 8
"""Lines lie so far to each side of the floor's part that is looked at."""
AHEAD_M = 4.0
"""Distance of that part where the camera does not look down on it: a whole person fits the picture there."""
PIECES = 4
"""Pieces of a meter, each straight, as a lens with distortion bends lines."""
MARGIN = 0.1
"""Share of the picture's size beyond which nothing is drawn: distortion is not defined far outside."""
HORIZON_DEGREES = 60.0
HORIZON_PIECES = 48
FAR_M = 1e5


@dataclass(frozen=True, eq=False)
class FloorGrid:
    """Straight pieces of lines in the picture, each from one point to another [px]."""

    lines: Array
    """(S, 2, 2) of the grid."""
    depth_m: Array
    """(S,) distance of each from the camera, along the viewing axis [m]."""
    horizon: Array
    """(H, 2, 2) where the floor would end."""


def floor_grid(camera: Camera, frame: int | None = None) -> FloorGrid:
    """The grid of whole meters on the floor z = 0, about where the camera looks.

    Args:
        camera: The camera.
        frame: Index of its pose, where it moves.
    """
    rotation, location = camera.pose(frame)
    ahead = -rotation[:, 2]
    middle = np.round(location[:2] + _reach(location[2], ahead) * _level(rotation))
    steps = np.arange(-REACH_M, REACH_M + 1, dtype=np.float64)
    along = np.arange(-REACH_M * PIECES, REACH_M * PIECES + 1) / PIECES
    first, second = np.meshgrid(steps, along, indexing="ij")
    flat = np.zeros((2, *first.shape, 3))
    flat[0, ..., 0], flat[0, ..., 1] = middle[0] + first, middle[1] + second
    flat[1, ..., 0], flat[1, ..., 1] = middle[0] + second, middle[1] + first
    pixel, depth = camera.project(flat, frame)
    pieces = np.stack([pixel[:, :, :-1], pixel[:, :, 1:]], axis=-2).reshape(-1, 2, 2)
    nearer = np.minimum(depth[:, :, :-1], depth[:, :, 1:]).ravel()
    shown = _in_picture(camera, pieces)
    return FloorGrid(pieces[shown], nearer[shown], _horizon(camera, frame))


def _reach(height_m: float, ahead: Array) -> float:
    """Distance over the floor to the part that is looked at [m]."""
    level = float(np.hypot(ahead[0], ahead[1]))
    if ahead[2] >= 0.0 or height_m <= 0.0:
        return AHEAD_M
    return min(height_m * level / -float(ahead[2]), AHEAD_M)


def _level(rotation: Array) -> Array:
    """(2,) unit direction over the floor in which a camera looks."""
    heading = heading_rad(rotation)
    return np.array([-np.sin(heading), np.cos(heading)])


def _horizon(camera: Camera, frame: int | None) -> Array:
    rotation, location = camera.pose(frame)
    x, y = _level(rotation)
    angles = np.radians(np.linspace(-HORIZON_DEGREES, HORIZON_DEGREES, HORIZON_PIECES + 1))
    far = np.stack(
        [x * np.cos(angles) - y * np.sin(angles), x * np.sin(angles) + y * np.cos(angles), 0.0 * angles],
        axis=-1,
    )
    pixel, _ = camera.project(location + FAR_M * far, frame)
    pieces = np.stack([pixel[:-1], pixel[1:]], axis=-2)
    return np.asarray(pieces[_in_picture(camera, pieces)])


def _in_picture(camera: Camera, pieces: Array) -> Array:
    """(S,) whether both ends of pieces (S, 2, 2) lie in the picture or a little outside."""
    size = np.array(camera.resolution, dtype=np.float64)
    with np.errstate(invalid="ignore"):
        within = (pieces >= -MARGIN * size) & (pieces <= (1.0 + MARGIN) * size)
    return np.asarray(within.all(axis=(-2, -1)))
