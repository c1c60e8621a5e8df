"""Overlays of running tools: joints to drag, lines that tell the camera, requests for clicks."""

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
from ..footage.camera_view import free_box
from ..footage.drawn_lines import Drawing, DrawnLine, current_camera, running
from ..footage.found_camera import HINTS, is_found, values
from ..shell.footage_clicks import WorldInRegion
from ..shell.footage_view import FootageRequest, FootageView, footage_view, shown_request
from ..shell.takes import find_take, footage_of
from . import drawing
from .drawing import side_color
from .figures import circles, segments

if TYPE_CHECKING:
    from ...core.camera.camera import Camera
    from ...core.camera.camera_evidence import FloorGrid


# --- Joints that can be dragged


@dataclass
class Handles:
    """State of the tool that drags joints."""

    hovered: str | None = None  # the joint that the mouse is over or drags
    keys: str = ""  # what can be pressed now
    path: tuple[str, Array] | None = None
    """The joint dragged last, and its path (2, I, 3) [m] around this frame: as stored, and as dragged."""


_handles: Handles | None = None


def show_handles(handles: Handles | None) -> None:
    """Draw the joints from now on; None ends the drawing."""
    global _handles
    _handles = handles


def show_keys(context: bpy.types.Context, words: str) -> None:
    """Show in the status bar, and beside the joint under the mouse, what keys do now."""
    context.workspace.status_text_set(words)
    if _handles is not None:
        _handles.keys = words


def draw_joints(context: bpy.types.Context) -> None:
    """Draw a ring at each joint of the active take's actor in a 3D view, a larger one under the mouse."""
    take = find_take(context.scene)
    if _handles is None or take is None or take.armature is None:
        return
    view = WorldInRegion(context.region, context.region_data)
    scale = drawing.ui_scale()
    if _handles.path is not None:
        _draw_path(view, *_handles.path)
    for name, place in zip(HUMAN.point_names, joint_places(take.armature), strict=True):
        position = view.position(place)
        if position is None:
            continue
        hovered, color = name == _handles.hovered, side_color(name)
        rim = circles(position[None], (9.0 if hovered else 6.0) * scale)
        drawing.polygons(rim, drawing.INK if hovered else drawing.faded(color, 0.35))
        drawing.lines(segments(rim, closed=True), np.array(color), width=2.0, halo=0.9)
        if hovered:
            _write_near(context, _handles.keys.split("   |   ")[::-1], *position + 18.0 * scale)


def _draw_path(view: WorldInRegion, joint: str, places: Array) -> None:
    """A faint line as stored; one in the side's color as dragged, with a dot at each frame."""
    seen = [[view.position(place) for place in path] for path in places]
    unseen = np.full(2, np.nan)
    before, after = (np.array([unseen if at is None else at for at in path]) for path in seen)
    color = side_color(joint)
    drawing.lines(segments(before), drawing.faded(drawing.INK, drawing.GHOST), halo=drawing.GHOST)
    drawing.lines(segments(after), np.array(color), halo=0.9)
    drawing.polygons(circles(after, 2.5 * drawing.ui_scale(), 8), color)


# --- Lines that tell the camera


COLORS: dict[str, drawing.Color] = {
    "VERTICAL": (0.35, 0.6, 1.0, 1.0),
    "LEVEL": (1.0, 0.4, 0.4, 1.0),
    "ACROSS": (0.55, 0.9, 0.35, 1.0),
    "HEIGHT": (1.0, 0.9, 0.3, 1.0),
}
"""Plumb lines have the color of Blender's Z axis, level ones those of X and Y."""


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
            drawing.text(words, float(x) + 8.0 * drawing.ui_scale(), float(y), COLORS[line.kind])
    _draw_found(view, tool)


def _draw_line(view: FootageView, line: DrawnLine, active: bool, frame: int) -> None:
    there = 1.0 if line.kind != "HEIGHT" or line.frame == frame else 0.45
    color = drawing.faded(COLORS[line.kind], there)
    ends = view.to_region(np.array(line.ends, dtype=np.float64))
    drawing.lines(ends[None], color, width=2.5 if active else 1.5, halo=0.8 * there)
    half = 4.0 * drawing.ui_scale() * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    drawing.polygons(ends[:, None] + half, color)


def _draw_found(view: FootageView, tool: Drawing) -> None:
    """Write what the lines say of the camera at the lower edge of the picture."""
    left = max(0.0, float(view.top_left[0]))
    bottom = max(0.0, float((view.top_left + view.extent)[1]))
    scale = drawing.ui_scale()
    for number, sentence in enumerate(reversed(_sentences(tool))):
        drawing.text(sentence, left + 14.0 * scale, bottom + (14.0 + 18.0 * number) * scale)


def _sentences(tool: Drawing) -> list[str]:
    if tool.fit is None:
        return ["No line yet: the grid shows the camera as it is"]
    if not is_found(tool.fit):
        return ["This says nothing of the camera yet"]
    rows = [values(tool.fit), f"Lines are {tool.fit.misfit_px:.1f} px off"]
    return rows + [HINTS[name] for name in tool.fit.kept if name in ("height", "tilt", "roll")]


# --- The floor


GRID: drawing.Color = (0.55, 0.95, 1.0, 0.9)
HORIZON: drawing.Color = (1.0, 0.85, 0.45, 0.9)


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
    colors[:, 3] /= 1.0 + 2.0 * np.minimum(grid.depth_m / 8.0, 2.0)  # a third at 8 m
    drawing.lines(view.to_region(grid.lines), colors, width=1.2, halo=0.0)
    drawing.lines(view.to_region(grid.horizon), drawing.faded(HORIZON, opacity), width=1.2, halo=0.3)


def _key(camera: "Camera") -> tuple[float | int, ...]:
    flat: Array = np.asarray(camera.matrix_world)
    lens = (camera.lens_mm, camera.sensor_width_mm, *camera.resolution, camera.shift_x, camera.shift_y)
    return (*lens, *camera.distortion, *flat.ravel().tolist())


@lru_cache(maxsize=4)
def _grid(key: tuple[float | int, ...]) -> "FloorGrid":
    """The grid of a camera; the same from one redraw to the next."""
    from ...core.camera.camera import Camera
    from ...core.camera.camera_evidence import floor_grid

    lens_mm, sensor_width_mm, width, height, shift_x, shift_y, k1, k2, k3, *pose = key
    size = (int(width), int(height))
    matrix = np.array(pose).reshape(4, 4)
    return floor_grid(Camera(lens_mm, sensor_width_mm, size, matrix, shift_x, shift_y, (k1, k2, k3)))


# --- What an operator asks for


TITLE_SIZE, DETAIL_SIZE, NEAR_SIZE = 22.0, 14.0, 13.0


def draw_request(context: bpy.types.Context) -> None:
    """Write what is asked for at the region's top, below its headers, and beside the mouse."""
    take, request = find_take(context.scene), shown_request()
    if request is None or take is None:
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None and (request.of_footage or context.area.type != "VIEW_3D"):
        return
    scale, region = drawing.ui_scale(), context.region
    middle, top = 0.5 * region.width, region.height - 84.0 * scale
    drawing.text(request.title, middle, top, size=TITLE_SIZE, align="middle")
    if request.detail:
        below = top - 1.6 * DETAIL_SIZE * scale
        drawing.text(request.detail, middle, below, size=DETAIL_SIZE, align="middle")
    x, y = request.mouse[0] - region.x, request.mouse[1] - region.y
    if 0 <= x < region.width and 0 <= y < region.height:
        _near_mouse(context, request, view, float(x), float(y))


def _near_mouse(
    context: bpy.types.Context, request: FootageRequest, view: FootageView | None, x: float, y: float
) -> None:
    scale = drawing.ui_scale()
    words = [request.keys]
    if view is not None and request.head is not None:
        drawing.lines(np.array([[view.to_region(request.head), (x, y)]]), drawing.INK, halo=0.6)
    if view is not None and request.brush_px:
        around = circles(np.zeros((1, 2)), request.brush_px, 48)
        rim = view.to_region(view.to_footage((x, y)) + around)
        drawing.lines(segments(rim, closed=True), drawing.INK, halo=1.0)
        y = float(rim[..., 1].max())
    else:
        words += [each for each in (request.detail, request.title) if each]
    _write_near(context, words, x, y + 18.0 * scale)


def _write_near(context: bpy.types.Context, lines: list[str], x: float, y: float) -> None:
    """Write lines of text, the lowest first, to the right of a place, within what no sidebar covers."""
    scale, (_, _, free_px, _) = drawing.ui_scale(), free_box(context.area, context.region)
    for number, words in enumerate(lines):
        width = drawing.text_size(words, NEAR_SIZE)[0]
        left = max(min(x + 18.0 * scale, free_px - width - 18.0 * scale), 18.0 * scale)
        drawing.text(words, left, y + number * 1.5 * NEAR_SIZE * scale, size=NEAR_SIZE)
