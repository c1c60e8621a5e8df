"""Redrawing editors and their sidebars."""

from collections.abc import Iterator

import bpy
from bpy.app import timers

FOOTAGE_EDITORS = ("VIEW_3D", "CLIP_EDITOR")
SETTLING_S = 0.1
"""Delay after which everything has been drawn once."""


def areas(context: bpy.types.Context, *kinds: str) -> Iterator[bpy.types.Area]:
    """Yield the areas of these kinds in all windows."""
    for window in context.window_manager.windows:
        yield from (area for area in window.screen.areas if area.type in kinds)


def redraw_editors(context: bpy.types.Context, *kinds: str) -> None:
    """Redraw every editor of these kinds."""
    for area in areas(context, *kinds):
        area.tag_redraw()


def redraw_footage(context: bpy.types.Context) -> None:
    """Redraw every editor that can show footage."""
    redraw_editors(context, *FOOTAGE_EDITORS)


def redraw_sidebars(context: bpy.types.Context) -> None:
    """Redraw the sidebars, which show a job's progress."""
    for area in areas(context, *FOOTAGE_EDITORS):
        for region in area.regions:
            if region.type == "UI":
                region.tag_redraw()


def redraw_sidebars_soon() -> None:
    """Redraw the sidebars once more, after the next drawing.

    Blender moves sub-panels only when it draws once more after the panel above them has grown or shrunk.
    """
    if not bpy.app.background and not timers.is_registered(_redraw_once):
        timers.register(_redraw_once, first_interval=SETTLING_S)


def refresh_asset_browsers(context: bpy.types.Context) -> None:
    """Reload the assets and catalogs of open asset browsers."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.ui_type == "ASSETS":
                with context.temp_override(window=window, area=area):
                    if bpy.ops.asset.library_refresh.poll():
                        bpy.ops.asset.library_refresh()


def _redraw_once() -> None:
    redraw_sidebars(bpy.context)
