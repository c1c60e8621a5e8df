"""Overlay of the measuring operator: the clicked top of the head, and a line to the mouse."""

from dataclasses import dataclass

import bpy
import numpy as np

from ..shell.footage_view import footage_view
from ..shell.takes import find_take
from . import drawing

CROSS_PX = 7.0


@dataclass
class Clicks:
    """State of the running measurement."""

    head: tuple[float, float] | None = None
    """Footage pixel of the top of the head."""
    mouse: tuple[int, int] = (0, 0)
    """Position of the mouse in the window [px]."""


_running: Clicks | None = None


def show(clicks: Clicks | None) -> None:
    """Draw these clicks from now on; None ends the drawing."""
    global _running
    _running = clicks


def draw(context: bpy.types.Context) -> None:
    """Draw the first click and the height that a second one at the mouse would give."""
    take = find_take(context.scene)
    if _running is None or _running.head is None or take is None:
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return
    scale = drawing.ui_scale()
    head = view.to_region(_running.head)
    mouse = np.array(_running.mouse, dtype=np.float64) - (context.region.x, context.region.y)
    arms = CROSS_PX * scale * np.array([[[-1.0, 0.0], [1.0, 0.0]], [[0.0, -1.0], [0.0, 1.0]]])
    drawing.lines(head + arms, drawing.INK, halo=1.0)
    drawing.lines(np.stack([head, mouse])[None], drawing.INK, width=1.0, halo=0.6)
    words = "Top of Head"
    drawing.text(words, float(head[0]) + 1.5 * CROSS_PX * scale, float(head[1]) + 0.5 * CROSS_PX * scale)
