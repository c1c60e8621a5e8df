"""Overlays of running tools: joints to drag, lines that tell the camera, requests for clicks."""

from dataclasses import dataclass
from typing import ClassVar

import bpy
import numpy as np
from bpy.types import Context, Object, PropertyGroup

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.camera.camera_evidence import FloorGrid, floor_grid
from ..bridge.actor_bones import joint_places
from ..bridge.armature import read_body
from ..bridge.footage import still_camera
from ..bridge.keyframes import candidate_posture
from ..footage.camera_view import free_box
from ..footage.found_camera import HINTS, is_found, running, values
from ..shell.footage_view import FootageView, WorldInRegion, footage_view, shown_request
from ..shell.results import LruCache
from ..shell.take_state import TakeState
from ..shell.takes import find_take, footage_of, redraw_footage
from . import drawing
from .drawing import (
    Color,
    Fill,
    Item,
    Label,
    Stroke,
    Style,
    body_scale,
    faded,
    side_color,
    text_size,
    ui_scale,
)
from .figures import circles, limb_lines, segments
from .views import motion_view


@dataclass
class Handles:
    """State of the tool that drags joints."""

    drawn: "ClassVar[Handles | None]" = None  # the running tool's
    hovered: str | None = None  # the joint that the mouse is over or drags
    keys: str = ""  # what can be pressed now
    path: tuple[str, Array] | None = None
    """The joint dragged last, and its path (2, I, 3) [m] around this frame: as stored, and as dragged."""


def show_keys(context: Context, words: str) -> None:
    """Show in the status bar, and beside the joint under the mouse, what keys do now."""
    context.workspace.status_text_set(words)
    if Handles.drawn is not None:
        Handles.drawn.keys = words


def draw_joints(context: Context) -> list[Item]:
    """A ring at each joint of the active take's actor in a 3D view, a larger one under the mouse."""
    take, handles = find_take(context.scene), Handles.drawn
    if handles is None or take is None or take.armature is None:
        return []
    view, scale = WorldInRegion(context.region, context.region_data), ui_scale()
    items: list[Item] = []
    if handles.path is not None:  # faint as stored; in the side's color as dragged, with a dot at each frame
        joint, places = handles.path
        seen = [[view.position(place) for place in path] for path in places]
        unseen = np.full(2, np.nan)
        before, after = (np.array([unseen if at is None else at for at in path]) for path in seen)
        items.append(Stroke(segments(before), faded(drawing.INK, drawing.GHOST), 1.5, drawing.GHOST))
        items.append(Stroke(segments(after), side_color(joint), 1.5, 0.9))
        items.append(Fill(circles(after, 2.5 * scale, 8), side_color(joint)))
    for name, place in zip(HUMAN.point_names, joint_places(take.armature), strict=True):
        position = view.position(place)
        if position is None:
            continue
        hovered, color = name == handles.hovered, side_color(name)
        rim = circles(position[None], (9.0 if hovered else 6.0) * scale)
        items.append(Fill(rim, drawing.INK if hovered else faded(color, 0.35)))
        items.append(Stroke(segments(rim, closed=True), np.array(color), width=2.0, halo=0.9))
        if hovered:
            items += _near(context, handles.keys.split("   |   ")[::-1], *position + 18.0 * scale)
    return items


COLORS: dict[str, Color] = {
    "VERTICAL": (0.35, 0.6, 1.0, 1.0),
    "LEVEL": (1.0, 0.4, 0.4, 1.0),
    "ACROSS": (0.55, 0.9, 0.35, 1.0),
    "HEIGHT": (1.0, 0.9, 0.3, 1.0),
}
"""Plumb lines have the color of Blender's Z axis, level ones those of X and Y."""


def draw_camera_lines(context: Context) -> list[Item]:
    """The lines and the camera found, while the tool runs."""
    tool = running()
    view = None if tool is None else _view(context)
    if view is None or tool is None:
        return []
    items: list[Item] = []
    scale = ui_scale()
    half = 4.0 * scale * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    for number, line in enumerate(tool.lines):
        is_here = line.kind != "HEIGHT" or line.frame == context.scene.frame_current
        there = 1.0 if is_here else 0.45
        color = faded(COLORS[line.kind], there)
        ends = view.to_region(np.array(line.ends, dtype=np.float64))
        items.append(Stroke(ends[None], color, 2.5 if number == tool.last else 1.5, 0.8 * there))
        items.append(Fill(ends[:, None] + half, color))
        if line.kind == "HEIGHT":
            x, y = ends.mean(axis=0).tolist()
            items.append(Label(f"{tool.length_of(line):.2f} m", x + 8.0 * scale, y, COLORS[line.kind]))
    # What the lines say of the camera stands at the lower edge of the picture.
    left = max(0.0, float(view.top_left[0]))
    bottom = max(0.0, float((view.top_left + view.extent)[1]))
    if tool.fit is None:
        rows = ["No line yet: the grid shows the camera as it is"]
    elif not is_found(tool.fit):
        rows = ["This says nothing of the camera yet"]
    else:
        rows = [values(tool.fit), f"Lines are {tool.fit.misfit_px:.1f} px off"]
        rows += [HINTS[name] for name in tool.fit.kept if name in ("height", "tilt", "roll")]
    for number, sentence in enumerate(reversed(rows)):
        items.append(Label(sentence, left + 14.0 * scale, bottom + (14.0 + 18.0 * number) * scale))
    return items


def _view(context: Context) -> FootageView | None:
    """The region that is drawn as it shows the active take's footage; None if it does not."""
    take = find_take(context.scene)
    return None if take is None else footage_view(context.scene, take, context.area, context.region)


GRID: Color = (0.55, 0.95, 1.0, 0.9)
HORIZON: Color = (1.0, 0.85, 0.45, 0.9)
_grids: LruCache[FloorGrid] = LruCache(4)


def draw_floor_grid(context: Context) -> list[Item]:
    """The floor as the take's camera sees it, or the camera that is being found."""
    take, tool = find_take(context.scene), running()
    settings = context.scene.keymark.overlays
    if take is None or take.camera is None or not (settings.show_floor_grid or tool is not None):
        return []
    view = _view(context)
    if view is None:
        return []
    shown = None if tool is None or tool.fit is None else tool.fit.camera
    camera = shown or still_camera(footage_of(context.scene, take))
    lens = (camera.lens_mm, camera.sensor_width_mm, *camera.resolution, camera.shift_x, camera.shift_y)
    key = repr((lens, tuple(camera.distortion), np.asarray(camera.matrix_world).tolist()))
    grid = _grids.known(key, lambda: floor_grid(camera))
    assert grid is not None
    opacity = settings.opacity
    colors = np.tile(np.array(faded(GRID, opacity)), (len(grid.lines), 1))
    colors[:, 3] /= 1.0 + 2.0 * np.minimum(grid.depth_m / 8.0, 2.0)  # a third at 8 m
    return [
        Stroke(view.to_region(grid.lines), colors, 1.2),
        Stroke(view.to_region(grid.horizon), faded(HORIZON, opacity), 1.2, 0.3),
    ]


TITLE_SIZE, DETAIL_SIZE, NEAR_SIZE = 22.0, 14.0, 13.0


def draw_request(context: Context) -> list[Item]:
    """What is asked for, at the region's top, below its headers, and beside the mouse."""
    request = shown_request()
    if request is None or find_take(context.scene) is None:
        return []
    view = _view(context)
    if view is None and (request.of_footage or context.area.type != "VIEW_3D"):
        return []
    scale, region = ui_scale(), context.region
    middle, top = 0.5 * region.width, region.height - 84.0 * scale
    items: list[Item] = [Label(request.title, middle, top, align="middle", size=TITLE_SIZE)]
    if request.detail:
        below = top - 1.6 * DETAIL_SIZE * scale
        items.append(Label(request.detail, middle, below, align="middle", size=DETAIL_SIZE))
    x, y = float(request.mouse[0] - region.x), float(request.mouse[1] - region.y)
    if not (0 <= x < region.width and 0 <= y < region.height):
        return items
    words = [request.keys]
    if view is not None and request.head is not None:
        items.append(Stroke(np.array([[view.to_region(request.head), (x, y)]]), drawing.INK, 1.5, 0.6))
    if view is not None and request.brush_px:
        around = circles(np.zeros((1, 2)), request.brush_px, 48)
        rim = view.to_region(view.to_footage((x, y)) + around)
        items.append(Stroke(segments(rim, closed=True), drawing.INK, 1.5, 1.0))
        y = float(rim[..., 1].max())
    else:
        words += [each for each in (request.detail, request.title) if each]
    return items + _near(context, words, x, y + 18.0 * scale)


def _near(context: Context, rows: list[str], x: float, y: float) -> list[Item]:
    """Lines of text, the lowest first, to the right of a place, within what no sidebar covers."""
    scale, (_, _, free_px, _) = ui_scale(), free_box(context.area, context.region)
    items: list[Item] = []
    for number, words in enumerate(rows):
        width = text_size(words, NEAR_SIZE)[0]
        left = max(min(x + 18.0 * scale, free_px - width - 18.0 * scale), 18.0 * scale)
        items.append(Label(words, left, y + number * 1.5 * NEAR_SIZE * scale, size=NEAR_SIZE))
    return items


_points: LruCache[Array] = LruCache()
"""(N, 13, 3) points of a found keyframe's candidates, by what they depend on."""
_looked_at: tuple[float, int] = (np.nan, 0)
"""Scene frame, and the candidate there whose button the mouse was over last."""


def look_at(context: Context, candidate: int) -> None:
    """Draw a candidate of the current frame; called where Blender asks for the tooltip of its button."""
    global _looked_at
    wanted = float(context.scene.frame_current_final), candidate
    if wanted != _looked_at:
        _looked_at = wanted
        redraw_footage(context)


def draw_candidate(context: Context) -> list[Item]:
    """The figure of the candidate, at a frame that nobody has decided on."""
    scene = context.scene
    settings, take = scene.keymark.overlays, find_take(scene)
    if take is None or not settings.show_candidates or context.screen.is_animation_playing:
        return []
    frame, candidate = _looked_at
    state = TakeState(take)
    if frame != scene.frame_current_final or take.armature is None or not state.shows_keyframes:
        return []
    place, view = state.match_at(frame), motion_view(context, take)
    match = take.matching.matches[place] if place >= 0 else None
    if match is None or len(match.candidates) < 2 or state.of_match(match) != "FOUND":
        match = state.offered_at(frame)
    # The frame may have got other candidates since.
    if match is None or view is None or candidate == match.chosen or candidate >= len(match.candidates):
        return []
    positions = view.project(candidate_points(take.armature, match))
    return candidate_figure(positions, candidate, match.chosen, settings)


def candidate_points(armature_object: Object, match: PropertyGroup) -> Array:
    """(N, 13, 3) points of a found keyframe's candidates in the world."""
    places = [[*candidate.place, *candidate.turns] for candidate in match.candidates]
    lengths = [bone.length for bone in armature_object.data.bones]
    key = f"{armature_object.session_uid} {lengths} {tuple(armature_object.scale)} {places}"

    def found() -> Array:
        body = read_body(armature_object)
        return np.stack([body.points(body.pose(candidate_posture(each))) for each in match.candidates])

    points = _points.known(key, found)
    assert points is not None
    return points


def candidate_figure(positions: Array, candidate: int, chosen: int, settings: PropertyGroup) -> list[Item]:
    """A candidate by the pixels (N, 13, 2) of all, numbered where it is farthest from the chosen one."""
    scale, figure = drawing.ui_scale(), positions[candidate]
    tall_px = float(np.ptp(np.nan_to_num(figure[:, 1])))
    style = Style(settings.opacity, scale, body_scale(np.array([tall_px / drawing.TALL_M]), scale))
    width = style.limb * style.width * style.body_scale
    themed = bpy.context.preferences.themes[0].collection_color[candidate % drawing.CANDIDATE_COLORS].color
    color = style.color(faded(themed, drawing.GHOST))
    lines, sides = limb_lines(HUMAN.point_names, figure)
    items: list[Item] = [
        Stroke(lines, color, width, drawing.GHOST * style.halo),
        Stroke(lines[sides == "R"], style.color(drawing.CORE), style.core * width),
    ]
    apart = np.nan_to_num(np.linalg.norm(figure - positions[chosen], axis=-1), nan=-1.0)
    if apart.max() >= 0.0:
        x, y = figure[apart.argmax()]
        items.append(Label(str(candidate + 1), float(x), float(y) + 6.0 * scale, (*color[:3], 1.0), "middle"))
    return items
