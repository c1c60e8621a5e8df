"""Overlay of the joints that can be dragged: a ring at each, a larger one under the mouse."""

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.errors import InputError
from ..bridge.camera_placement import still_camera
from ..bridge.object_space import joint_places
from ..footage.drawn_lines import Drawing, DrawnLine, current_camera, running
from ..footage.found_camera import HINTS, is_found, values
from ..shell.footage_clicks import WorldInRegion
from ..shell.footage_view import FootageView, footage_view
from ..shell.takes import find_take, footage_of
from . import drawing
from .drawing import side_color
from .figures import circles, segments

if TYPE_CHECKING:
    from ...core.footage.camera import Camera
    from ...core.footage.camera_evidence import FloorGrid


HANDLE_PX, HOVERED_PX = 6.0, 9.0
"""Radius of a joint's ring, and of the one under the mouse."""
INSIDE = 0.35
"""Opacity of a ring's inside: the footage under it stays to be seen."""
CORNERS = 24


@dataclass
class Handles:
    """State of the running tool."""

    hovered: str | None = None
    """The joint that the mouse is over or drags."""


_running: Handles | None = None


def show(handles: Handles | None) -> None:
    """Draw the joints from now on; None ends the drawing."""
    global _running
    _running = handles


def draw(context: bpy.types.Context) -> None:
    """Draw the joints of the active take's actor in a 3D view."""
    take = find_take(context.scene)
    if _running is None or take is None or take.armature is None:
        return
    view = WorldInRegion(context.region, context.region_data)
    scale = drawing.ui_scale()
    for name, place in zip(HUMAN.point_names, joint_places(take.armature), strict=True):
        position = view.position(place)
        if position is None:
            continue
        hovered = name == _running.hovered
        radius = (HOVERED_PX if hovered else HANDLE_PX) * scale
        rim = circles(position[None], radius, CORNERS)
        color = side_color(name)
        drawing.polygons(rim, drawing.INK if hovered else drawing.faded(color, INSIDE))
        drawing.lines(segments(rim, closed=True), np.array(color), width=2.0, halo=0.9)


# --- Overlay of the tool that finds the camera


COLORS: dict[str, drawing.Color] = {
    "VERTICAL": (0.35, 0.6, 1.0, 1.0),
    "LEVEL": (1.0, 0.4, 0.4, 1.0),
    "ACROSS": (0.55, 0.9, 0.35, 1.0),
    "HEIGHT": (1.0, 0.9, 0.3, 1.0),
}
"""Plumb lines have the color of Blender's Z axis, level ones those of X and Y."""
END_PX = 4.0
"""Half the side of the square at an end."""
MARGIN_PX, ROW_PX = 14.0, 18.0
BESIDE_PX = 8.0
ELSEWHERE = 0.45
"""Opacity of a performer's height that was drawn in another frame."""


def draw_camera_lines(context: bpy.types.Context) -> None:
    """Draw the lines and the camera found, while the tool runs."""
    take, tool = find_take(context.scene), running()
    if take is None or tool is None:
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return
    for number, line in enumerate(tool.lines):
        _draw_line(view, line, number == tool.last, context.scene.frame_current)
        if line.kind == "HEIGHT":
            x, y = view.to_region(np.array(line.ends, dtype=np.float64)).mean(axis=0)
            words = f"{tool.length_of(line):.2f} m"
            drawing.text(words, float(x) + BESIDE_PX * drawing.ui_scale(), float(y), COLORS[line.kind])
    _draw_found(context, view, tool)


def _draw_line(view: FootageView, line: DrawnLine, active: bool, frame: int) -> None:
    there = 1.0 if line.kind != "HEIGHT" or line.frame == frame else ELSEWHERE
    color = drawing.faded(COLORS[line.kind], there)
    ends = view.to_region(np.array(line.ends, dtype=np.float64))
    drawing.lines(ends[None], color, width=2.5 if active else 1.5, halo=0.8 * there)
    half = END_PX * drawing.ui_scale() * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    drawing.polygons(ends[:, None] + half, color)


def _draw_found(context: bpy.types.Context, view: FootageView, tool: Drawing) -> None:
    """Write what the lines say of the camera at the lower edge of the picture."""
    left = max(0.0, float(view.top_left[0]))
    bottom = max(0.0, float((view.top_left + view.extent)[1]))
    scale = drawing.ui_scale()
    rows = _sentences(tool)
    for number, sentence in enumerate(reversed(rows)):
        drawing.text(sentence, left + MARGIN_PX * scale, bottom + (MARGIN_PX + ROW_PX * number) * scale)


def _sentences(tool: Drawing) -> list[str]:
    if tool.fit is None:
        return ["No line yet: the grid shows the camera as it is"]
    if not is_found(tool.fit):
        return ["This says nothing of the camera yet"]
    rows = [values(tool.fit), f"Lines are {tool.fit.misfit_px:.1f} px off"]
    return rows + [HINTS[name] for name in tool.fit.kept if name in ("height", "tilt", "roll")]


# --- Overlay of the floor


GRID: drawing.Color = (0.55, 0.95, 1.0, 0.9)
HORIZON: drawing.Color = (1.0, 0.85, 0.45, 0.9)
FADING_M = 8.0
"""Depth over which the grid fades to a third [m]."""


def draw_floor_grid(context: bpy.types.Context) -> None:
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
    from ...core.footage.camera_evidence import floor_grid

    lens_mm, sensor_width_mm, width, height, shift_x, shift_y, k1, k2, k3, *pose = key
    size = (int(width), int(height))
    matrix = np.array(pose).reshape(4, 4)
    return floor_grid(Camera(lens_mm, sensor_width_mm, size, matrix, shift_x, shift_y, (k1, k2, k3)))
