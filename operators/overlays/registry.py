"""Registry of the overlays, and their draw handlers in Blender's editors."""

import logging
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import bpy
import gpu

from ...core.errors import KeymarkError

DrawFunction = Callable[[bpy.types.Context], None]

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Overlay:
    """A draw function, and the editor it draws in."""

    name: str
    """Name that users see."""
    module: str
    """Module in this folder with the function `draw(context)`."""
    space: str
    """Space of the editor, a class of `bpy.types`."""
    region: str = "WINDOW"
    phase: str = "POST_PIXEL"


OVERLAYS = (
    Overlay("Masks in the Viewport", "mask", "SpaceView3D"),
    Overlay("Masks in the Clip Editor", "mask", "SpaceClipEditor"),
    Overlay("Ignored Regions in the Viewport", "ignored", "SpaceView3D"),
    Overlay("Ignored Regions in the Clip Editor", "ignored", "SpaceClipEditor"),
    Overlay("Keypoints in the Viewport", "keypoints", "SpaceView3D"),
    Overlay("Keypoints in the Clip Editor", "keypoints", "SpaceClipEditor"),
    Overlay("Candidates in the Viewport", "candidates", "SpaceView3D"),
    Overlay("Candidates in the Clip Editor", "candidates", "SpaceClipEditor"),
    Overlay("Motion in the Viewport", "viewport", "SpaceView3D"),
    Overlay("Motion in the Clip Editor", "clip_editor", "SpaceClipEditor"),
    Overlay("Floor Grid in the Viewport", "floor_grid", "SpaceView3D"),
    Overlay("Floor Grid in the Clip Editor", "floor_grid", "SpaceClipEditor"),
    Overlay("Camera's Lines in the Viewport", "camera_lines", "SpaceView3D"),
    Overlay("Camera's Lines in the Clip Editor", "camera_lines", "SpaceClipEditor"),
    Overlay("Measuring in the Viewport", "measuring", "SpaceView3D"),
    Overlay("Measuring in the Clip Editor", "measuring", "SpaceClipEditor"),
    Overlay("Requests in the Viewport", "request", "SpaceView3D"),
    Overlay("Requests in the Clip Editor", "request", "SpaceClipEditor"),
    Overlay("Joints to Drag", "handles", "SpaceView3D"),
    Overlay("Speed and Confidence in the Timeline", "timeline", "SpaceDopeSheetEditor"),
)
"""All overlays; those of one editor are drawn in this order."""

_handlers: list[tuple[Overlay, Any]] = []
_failures: dict[Overlay, str] = {}


def guarded(overlay: Overlay, draw: DrawFunction) -> Callable[[], None]:
    """A draw handler: `draw` with blending, disabled after its first unexpected failure.

    A failure is logged once: logged at every redraw it would flood the console.
    """

    def handler() -> None:
        if overlay in _failures:
            return
        gpu.state.blend_set("ALPHA")
        try:
            draw(bpy.context)
        except KeymarkError:
            pass  # a camera of an unsupported type, for example: nothing can be drawn until that is changed
        except Exception as error:
            _failures[overlay] = str(error) or type(error).__name__
            logger.exception("Keymark's overlay '%s' failed and is switched off", overlay.name)
        finally:
            gpu.state.blend_set("NONE")

    return handler


def failures() -> dict[str, str]:
    """Messages of the failures, by name of the disabled overlay."""
    return {overlay.name: sentence for overlay, sentence in _failures.items()}


def try_again() -> None:
    """Enable overlays that failed."""
    _failures.clear()


def redraw(context: bpy.types.Context) -> None:
    """Redraw every editor that shows an overlay."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if any(isinstance(area.spaces.active, getattr(bpy.types, it.space)) for it in OVERLAYS):
                area.tag_redraw()


def register() -> None:
    """Add the draw handlers, unless Blender runs in the background."""
    if bpy.app.background:
        return
    for overlay in OVERLAYS:
        draw = import_module(f".{overlay.module}", __package__).draw
        space = getattr(bpy.types, overlay.space)
        handler = space.draw_handler_add(guarded(overlay, draw), (), overlay.region, overlay.phase)
        _handlers.append((overlay, handler))


def unregister() -> None:
    """Remove them."""
    while _handlers:
        overlay, handler = _handlers.pop()
        getattr(bpy.types, overlay.space).draw_handler_remove(handler, overlay.region)
    _failures.clear()
