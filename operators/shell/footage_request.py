"""What an operator that waits for clicks on the footage asks for.

It stands in the status bar, in the headers of the editors, and near the mouse, where an overlay draws it.
"""

from dataclasses import dataclass

import bpy

from .redraw import FOOTAGE_EDITORS, areas, redraw_footage

SIDES = {".L": "the performer's own left", ".R": "the performer's own right"}
"""Of what people read as left or right of the picture."""


@dataclass
class FootageRequest:
    """What is asked for now."""

    title: str
    """As in `Click on: Forearm Left`."""
    detail: str = ""
    """What is easily mistaken about it."""
    brush_px: float = 0.0
    """Radius of a brush in pixels of the footage; 0 for an operator without one."""
    mouse: tuple[int, int] = (-1, -1)
    """Position of the mouse in the window [px]."""


_request: FootageRequest | None = None


def shown_request() -> FootageRequest | None:
    """What is asked for now; None if nothing is."""
    return _request


def side_of(name: str) -> str:
    """Whose left or right a body part or point is; empty for those in the middle."""
    side = SIDES.get(name[-2:])
    return side if side else ""


def ask(context: bpy.types.Context, request: FootageRequest, keys: str) -> None:
    """Ask for something.

    Args:
        context: Its windows show it.
        request: What is asked for.
        keys: The keys that may be pressed, for the status bar.
    """
    global _request
    if _request is not None and request.mouse == (-1, -1):
        request.mouse = _request.mouse
    _request = request
    sentence = f"{request.title}, {request.detail}" if request.detail else request.title
    context.workspace.status_text_set(f"{sentence}   |   {keys}")
    for area in areas(context, *FOOTAGE_EDITORS):
        area.header_text_set(sentence)
    redraw_footage(context)


def follow_mouse(context: bpy.types.Context, event: bpy.types.Event) -> None:
    """Let the request follow the mouse."""
    if _request is not None and (event.mouse_x, event.mouse_y) != _request.mouse:
        _request.mouse = event.mouse_x, event.mouse_y
        redraw_footage(context)


def stop_asking(context: bpy.types.Context) -> None:
    """Ask for nothing; status bar, headers and cursor are as before."""
    global _request
    _request = None
    if context.window is None:  # Blender closes it or opens another file
        return
    context.window.cursor_modal_restore()
    context.workspace.status_text_set(None)
    for area in areas(context, *FOOTAGE_EDITORS):
        area.header_text_set(None)
    redraw_footage(context)
