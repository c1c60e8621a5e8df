"""A viewport keeps the footage beside its sidebar: fitted anew when that is opened or gets another width.

A view that the person has moved or zoomed stays as it is; one that was fitted here, or that Blender has
centered, which puts it under the sidebar, does not.
"""

from functools import partial
from math import isclose

import bpy
from bpy.app import timers

from ..shell.takes import find_take
from .camera_view import View, fit_beside_sidebar, fitting_view

SAME = 1e-4
"""Difference within which views are one; Blender keeps them in single precision."""

_fitted: dict[int, View] = {}
"""The view that was fitted last, by the pointer of an area."""


def keep_beside_sidebar(context: bpy.types.Context) -> None:
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


def _wanted(area: bpy.types.Area, scene: bpy.types.Scene) -> View | None:
    take, space = find_take(scene), area.spaces.active
    if take is None or take.clip is None or take.camera is None or space.region_3d is None:
        return None
    camera = space.camera if space.use_local_camera else scene.camera
    if camera != take.camera or space.region_3d.view_perspective != "CAMERA":
        return None
    return fitting_view(area, scene.render, take.camera.data)


def _shown(area: bpy.types.Area) -> View:
    view = area.spaces.active.region_3d
    x, y = view.view_camera_offset
    return view.view_camera_zoom, x, y


def _fit(address: int) -> None:
    """Fit the view of an area, if it is still there."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.as_pointer() == address and area.type == "VIEW_3D":
                take, wanted = find_take(window.scene), _wanted(area, window.scene)
                if take is not None and wanted is not None and may_move(_shown(area), _fitted.get(address)):
                    fit_beside_sidebar(area, window.scene.render, take.camera.data)
                    _fitted[address] = wanted
                    area.tag_redraw()
