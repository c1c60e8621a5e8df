"""Operators that wait for a click on the footage: events they pass on, and whether footage is shown."""

import bpy

from .error_reports import reported
from .footage_view import shows_footage

NAVIGATION = {
    *(
        "MIDDLEMOUSE",
        "WHEELUPMOUSE",
        "WHEELDOWNMOUSE",
        "TRACKPADPAN",
        "TRACKPADZOOM",
        "MOUSEPAN",
        "MOUSEZOOM",
    ),
    *("HOME", "LEFT_ARROW", "RIGHT_ARROW", "UP_ARROW", "DOWN_ARROW", "NUMPAD_PLUS", "NUMPAD_MINUS"),
}
"""Events that move the view or change the frame; the operator passes them on to Blender."""


def footage_is_shown(
    operator: bpy.types.Operator, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> bool:
    """Whether an editor of the window shows the take's footage; if not, an error is reported."""
    with reported(operator):
        if shows_footage(context, take):
            return True
        operator.report(
            {"ERROR"},
            "Look through the take's camera first (Numpad 0), or open the clip in a Movie Clip editor",
        )
    return False
