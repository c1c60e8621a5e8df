"""Overlay of the floor: a grid of meters and the horizon, through the footage's camera."""

from functools import lru_cache
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ..bridge.camera_placement import still_camera
from ..footage.drawn_lines import current_camera, running
from ..shell.footage_view import footage_view
from ..shell.takes import find_take, footage_of
from . import drawing

if TYPE_CHECKING:
    from ...core.footage.camera import Camera
    from ...core.footage.floor_grid import FloorGrid

GRID: drawing.Color = (0.55, 0.95, 1.0, 0.9)
HORIZON: drawing.Color = (1.0, 0.85, 0.45, 0.9)
FADING_M = 8.0
"""Depth over which the grid fades to a third [m]."""


def draw(context: bpy.types.Context) -> None:
    """Draw the floor as the take's camera sees it, or the camera that is being found."""
    take, tool = find_take(context.scene), running()
    settings = context.scene.keymark.overlays
    if take is None or take.camera is None or not (settings.show_floor_grid or tool is not None):
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return
    try:
        camera = current_camera(tool) or still_camera(footage_of(context.scene, take))
    except InputError:  # of an unsupported type, as the panel says
        return
    grid = _grid(_key(camera))
    opacity = settings.opacity
    colors = np.tile(np.array(drawing.faded(GRID, opacity)), (len(grid.lines), 1))
    colors[:, 3] /= 1.0 + 2.0 * np.minimum(grid.depth_m / FADING_M, 2.0)
    drawing.lines(view.to_region(grid.lines), colors, width=1.2, halo=0.0)
    drawing.lines(view.to_region(grid.horizon), drawing.faded(HORIZON, opacity), width=1.2, halo=0.3)


def _key(camera: "Camera") -> tuple[float | int, ...]:
    flat: Array = np.asarray(camera.matrix_world)
    lens = (camera.lens_mm, camera.sensor_width_mm, *camera.resolution, camera.shift_x, camera.shift_y)
    return (*lens, *camera.distortion, *flat.ravel().tolist())


@lru_cache(maxsize=4)
def _grid(key: tuple[float | int, ...]) -> "FloorGrid":
    """The grid of a camera; the same from one redraw to the next."""
    from ...core.footage.camera import Camera
    from ...core.footage.floor_grid import floor_grid

    lens_mm, sensor_width_mm, width, height, shift_x, shift_y, k1, k2, k3, *pose = key
    size = (int(width), int(height))
    matrix = np.array(pose).reshape(4, 4)
    return floor_grid(Camera(lens_mm, sensor_width_mm, size, matrix, shift_x, shift_y, (k1, k2, k3)))
