"""Blender's camera view: zoom and offset that show the whole footage beside the sidebar, not under it."""

from functools import partial
from math import isclose, sqrt

import bpy
from bpy.app import timers
from bpy.types import Area, Camera, Context, Object, Region, RenderSettings, Scene, SpaceView3D

from ..shell.takes import find_take

MARGIN_PX = 12.0  # Margin between the picture and the panels around it
LEAST_SHARE = 0.3  # Least free share of a viewport; with less, the picture fills the whole viewport
ZOOMS = (-30.0, 600.0)  # Blender's limits

Box = tuple[float, float, float, float]  # Left, bottom, right, top [px]
View = tuple[float, float, float]
"""Zoom and offset of a camera view, as Blender keeps them in single precision."""


def fit_beside_sidebar(area: Area, render: RenderSettings, camera: Camera) -> None:
    """Let the camera's picture fill the part of a viewport that no panel covers."""
    fitting = fitting_view(area, render, camera)
    if fitting is not None:
        view = area.spaces.active.region_3d
        view.view_camera_zoom, view.view_camera_offset = fitting[0], fitting[1:]


def fitting_view(area: Area, render: RenderSettings, camera: Camera) -> View | None:
    """Return the camera view that shows the whole picture beside the panels; None where there is no room."""
    region = next((each for each in area.regions if each.type == "WINDOW"), None)
    view = area.spaces.active.region_3d
    if region is None or view is None or min(region.width, region.height) < 2:
        return None
    size = (render.resolution_x * render.pixel_aspect_x, render.resolution_y * render.pixel_aspect_y)
    picture = picture_at_factor_one((region.width, region.height), size, camera.sensor_fit)
    zoom, offset = camera_view((region.width, region.height), free_box(area, region), picture)
    return zoom, *offset


def free_box(area: Area, region: Region) -> Box:
    """Return the part of a region that no sidebar, toolbar or header covers, from the region's own corner."""
    left, bottom, right, top = 0.0, 0.0, float(region.width), float(region.height)
    for other in area.regions:
        if other.type not in {"UI", "TOOLS", "HEADER", "TOOL_HEADER"} or min(other.width, other.height) < 2:
            continue
        x, y = other.x - region.x, other.y - region.y
        if x + other.width <= 0 or x >= region.width or y + other.height <= 0 or y >= region.height:
            continue  # no overlap
        across = other.type in {"HEADER", "TOOL_HEADER"}
        if across and 2 * y > region.height:
            top = min(top, y)
        elif across:
            bottom = max(bottom, y + other.height)
        elif 2 * x > region.width:
            right = min(right, x)
        else:
            left = max(left, x + other.width)
    if right - left < LEAST_SHARE * region.width or top - bottom < LEAST_SHARE * region.height:
        return 0.0, 0.0, float(region.width), float(region.height)
    return left, bottom, right, top


def picture_at_factor_one(
    region_size: tuple[int, int], picture: tuple[float, float], sensor_fit: str
) -> tuple[float, float]:
    """Width and height [px] of the picture with the side that the sensor fit names as long as a region's."""
    if sensor_fit == "AUTO":
        scale = max(region_size) / max(picture)
    else:
        side = 0 if sensor_fit == "HORIZONTAL" else 1
        scale = region_size[side] / picture[side]
    return picture[0] * scale, picture[1] * scale


def camera_view(
    region_size: tuple[int, int], free: Box, picture: tuple[float, float]
) -> tuple[float, tuple[float, float]]:
    """Zoom and offset that fit a picture into a part; Blender scales by (sqrt(2) + zoom / 50)^2 / 4."""
    left, bottom, right, top = free
    room = max(right - left - 2.0 * MARGIN_PX, 1.0), max(top - bottom - 2.0 * MARGIN_PX, 1.0)
    factor = min(have / want for have, want in zip(room, picture, strict=True))
    zoom = min(max((2.0 * sqrt(factor) - sqrt(2.0)) * 50.0, ZOOMS[0]), ZOOMS[1])
    factor = ((sqrt(2.0) + zoom / 50.0) / 2.0) ** 2
    away = (0.5 * (region_size[0] - left - right), 0.5 * (region_size[1] - bottom - top))
    return zoom, (away[0] / (2.0 * factor * region_size[0]), away[1] / (2.0 * factor * region_size[1]))


def look_through(space: SpaceView3D, scene: Scene, camera: Object) -> None:
    """Let one viewport look through a camera; the scene keeps its active camera."""
    space.use_local_camera = camera != scene.camera
    if space.use_local_camera:
        space.camera = camera
    space.region_3d.view_perspective = "CAMERA"


SAME = 1e-4  # Difference within which views are one; Blender keeps them in single precision

_fitted: dict[int, View] = {}  # The view that was fitted last, by the pointer of an area


def keep_beside_sidebar(context: Context) -> None:
    """Fit the view of the take's camera again, after this drawing, if the sidebar has changed."""
    wanted = _wanted(context.area, context.scene)
    if wanted is None:
        return
    address, shown = context.area.as_pointer(), _shown(context.area)
    if is_same(shown, wanted):
        _fitted[address] = wanted
    elif may_move(shown, _fitted.get(address)):
        timers.register(partial(_fit, address), first_interval=0.0)


def may_move(shown: View, fitted: View | None) -> bool:
    """Whether nobody has moved a view: it is as it was fitted, or as Blender centers it."""
    centered = shown[1:] == (0.0, 0.0)
    return centered or (fitted is not None and is_same(shown, fitted))


def is_same(first: View, second: View) -> bool:
    """Whether two views are one."""
    return all(isclose(a, b, rel_tol=SAME, abs_tol=SAME) for a, b in zip(first, second, strict=True))


def _wanted(area: Area, scene: Scene) -> View | None:
    take, space = find_take(scene), area.spaces.active
    if take is None or take.clip is None or take.camera is None or space.region_3d is None:
        return None
    camera = space.camera if space.use_local_camera else scene.camera
    if camera != take.camera or space.region_3d.view_perspective != "CAMERA":
        return None
    return fitting_view(area, scene.render, take.camera.data)


def _shown(area: Area) -> View:
    view = area.spaces.active.region_3d
    x, y = view.view_camera_offset
    return view.view_camera_zoom, x, y


def _fit(address: int) -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.as_pointer() == address and area.type == "VIEW_3D":
                take, wanted = find_take(window.scene), _wanted(area, window.scene)
                if take is not None and wanted is not None and may_move(_shown(area), _fitted.get(address)):
                    fit_beside_sidebar(area, window.scene.render, take.camera.data)
                    _fitted[address] = wanted
                    area.tag_redraw()
