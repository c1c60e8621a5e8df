"""Overlay of the joints that can be dragged: a ring at each, a larger one under the mouse."""

from dataclasses import dataclass

import bpy
import numpy as np

from ...core.body.human import HUMAN
from ..bridge.joint_places import joint_places
from ..shell.takes import find_take
from ..shell.view_under_mouse import WorldInRegion
from . import drawing
from .figures import circles, segments
from .style import side_color

HANDLE_PX, HOVERED_PX = 6.0, 9.0
"""Radius of a joint's ring, and of the one under the mouse."""
INSIDE = 0.35
"""Opacity of a ring's inside: the footage under it stays to be seen."""
CORNERS = 24


@dataclass
class Handles:
    """State of the running tool."""

    hovered: str | None = None
    """The joint that the mouse is over or drags."""


_running: Handles | None = None


def show(handles: Handles | None) -> None:
    """Draw the joints from now on; None ends the drawing."""
    global _running
    _running = handles


def draw(context: bpy.types.Context) -> None:
    """Draw the joints of the active take's actor in a 3D view."""
    take = find_take(context.scene)
    if _running is None or take is None or take.armature is None:
        return
    view = WorldInRegion(context.region, context.region_data)
    scale = drawing.ui_scale()
    for name, place in zip(HUMAN.point_names, joint_places(take.armature), strict=True):
        position = view.position(place)
        if position is None:
            continue
        hovered = name == _running.hovered
        radius = (HOVERED_PX if hovered else HANDLE_PX) * scale
        rim = circles(position[None], radius, CORNERS)
        color = side_color(name)
        drawing.polygons(rim, drawing.INK if hovered else drawing.faded(color, INSIDE))
        drawing.lines(segments(rim, closed=True), np.array(color), width=2.0, halo=0.9)
