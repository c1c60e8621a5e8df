"""Registry of the overlays, and their draw handlers in Blender's editors."""

import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import bpy
import gpu
from bpy.types import Context

from ...core.errors import KeymarkError
from ..shell.job_progress import job_is_running
from . import mask, motion, timeline, tools
from .drawing import Item, merged

DrawFunction = Callable[[Context], Iterable[Item]]
DRAGGING = "keymark.drag_joints"
logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Overlay:
    """What is drawn over an editor: a function gives the items, in the region that Blender is drawing."""

    name: str  # as users see it
    draw: DrawFunction
    space: str  # of the editor, a class of `bpy.types`
    correcting: bool = True  # whether it is drawn while joints are dragged, too
    of_performer: bool = False  # whether *Just My Character* hides it


def _in_both(
    name: str, draw: DrawFunction, correcting: bool = True, of_performer: bool = False
) -> tuple[Overlay, Overlay]:
    return (
        Overlay(f"{name} in the Viewport", draw, "SpaceView3D", correcting, of_performer),
        Overlay(f"{name} in the Clip Editor", draw, "SpaceClipEditor", correcting, of_performer),
    )


OVERLAYS = (
    *_in_both("Masks", mask.draw),
    *_in_both("Ignored Regions", mask.draw_ignored),
    *_in_both("Keypoints", motion.draw_keypoints, correcting=False, of_performer=True),
    *_in_both("Candidates", tools.draw_candidate, correcting=False, of_performer=True),
    *_in_both("Motion", motion.draw, of_performer=True),
    *_in_both("Floor Grid", tools.draw_floor_grid),
    *_in_both("Camera's Lines", tools.draw_camera_lines),
    *_in_both("Requests", tools.draw_request),
    Overlay("Joints to Drag", tools.draw_joints, "SpaceView3D"),
    Overlay("Speed and Confidence in the Timeline", timeline.draw, "SpaceDopeSheetEditor"),
)
"""All overlays; those of one editor are drawn in this order."""

_handlers: list[tuple[Overlay, Any]] = []
FAILURES: dict[Overlay, str] = {}
"""Messages of unexpected failures: these overlays are switched off."""


def guarded(overlay: Overlay) -> Callable[[], None]:
    """A draw handler with blending, disabled after its first unexpected failure, which is logged once."""

    def handler() -> None:
        if overlay in FAILURES or (not overlay.correcting and job_is_running(bpy.context, DRAGGING)):
            return
        if overlay.of_performer and bpy.context.scene.keymark.overlays.only_character:
            return
        gpu.state.blend_set("ALPHA")
        try:
            for item in merged(overlay.draw(bpy.context)):
                item.draw()
        except KeymarkError:
            pass  # a camera of an unsupported type, for example: nothing can be drawn until that is changed
        except Exception as error:
            FAILURES[overlay] = str(error) or type(error).__name__
            logger.exception("Keymark's overlay '%s' failed and is switched off", overlay.name)
        finally:
            gpu.state.blend_set("NONE")

    return handler


def register() -> None:
    """Add the draw handlers, unless Blender runs in the background."""
    if bpy.app.background:
        return
    for overlay in OVERLAYS:
        space = getattr(bpy.types, overlay.space)
        handler = space.draw_handler_add(guarded(overlay), (), "WINDOW", "POST_PIXEL")
        _handlers.append((overlay, handler))


def unregister() -> None:
    """Remove them."""
    while _handlers:
        overlay, handler = _handlers.pop()
        getattr(bpy.types, overlay.space).draw_handler_remove(handler, "WINDOW")
    FAILURES.clear()
