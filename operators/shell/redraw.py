"""Having editors, or their sidebars, drawn again."""

from collections.abc import Iterator

import bpy
from bpy.app import timers

FOOTAGE_EDITORS = ("VIEW_3D", "CLIP_EDITOR")
SETTLING_S = 0.1
"""After which everything has been drawn once."""


def areas(context: bpy.types.Context, *kinds: str) -> Iterator[bpy.types.Area]:
    """Every area of these kinds, in all windows."""
    for window in context.window_manager.windows:
        yield from (area for area in window.screen.areas if area.type in kinds)


def redraw_editors(context: bpy.types.Context, *kinds: str) -> None:
    """Have every editor of these kinds drawn again."""
    for area in areas(context, *kinds):
        area.tag_redraw()


def redraw_footage(context: bpy.types.Context) -> None:
    """Have every editor that may show footage drawn again."""
    redraw_editors(context, *FOOTAGE_EDITORS)


def redraw_sidebars(context: bpy.types.Context) -> None:
    """Have every sidebar that shows a job's progress drawn again."""
    for area in areas(context, *FOOTAGE_EDITORS):
        for region in area.regions:
            if region.type == "UI":
                region.tag_redraw()


def redraw_sidebars_soon() -> None:
    """The same, once what has changed is drawn.

    Blender moves sub-panels only when it draws once more after the panel above them has grown or shrunk.
    """
    if not bpy.app.background and not timers.is_registered(_settle):
        timers.register(_settle, first_interval=SETTLING_S)


def refresh_asset_browsers(context: bpy.types.Context) -> None:
    """Let open asset browsers look again at what assets and catalogs there are."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.ui_type == "ASSETS":
                with context.temp_override(window=window, area=area):
                    if bpy.ops.asset.library_refresh.poll():
                        bpy.ops.asset.library_refresh()


def _settle() -> None:
    redraw_sidebars(bpy.context)
