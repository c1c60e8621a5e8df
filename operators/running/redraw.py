"""Having the sidebars drawn again."""

import bpy
from bpy.app import timers

SETTLING_S = 0.1
"""After which everything has been drawn once."""


def redraw_sidebars(context: bpy.types.Context) -> None:
    """Have every sidebar that shows a job's progress drawn again."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "CLIP_EDITOR"}:
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


def redraw_sidebars_soon() -> None:
    """The same, once what has changed is drawn.

    Blender moves sub-panels only when it draws once more after the panel above them has grown or shrunk.
    """
    if not bpy.app.background and not timers.is_registered(_settle):
        timers.register(_settle, first_interval=SETTLING_S)


def _settle() -> None:
    redraw_sidebars(bpy.context)
