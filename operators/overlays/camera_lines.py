"""Overlay of the tool that finds the camera: the lines drawn, and what they say of it."""

import bpy
import numpy as np

from ..footage.drawn_lines import Drawing, DrawnLine, running
from ..footage.found_camera import HINTS, is_found, values
from ..shell.footage_view import FootageView, footage_view
from ..shell.takes import find_take
from . import drawing

COLORS: dict[str, drawing.Color] = {
    "VERTICAL": (0.35, 0.6, 1.0, 1.0),
    "LEVEL": (1.0, 0.4, 0.4, 1.0),
    "ACROSS": (0.55, 0.9, 0.35, 1.0),
    "HEIGHT": (1.0, 0.9, 0.3, 1.0),
}
"""Plumb lines have the color of Blender's Z axis, level ones those of X and Y."""
END_PX = 4.0
"""Half the side of the square at an end."""
MARGIN_PX, ROW_PX = 14.0, 18.0
BESIDE_PX = 8.0
ELSEWHERE = 0.45
"""Opacity of a performer's height that was drawn in another frame."""


def draw(context: bpy.types.Context) -> None:
    """Draw the lines and the camera found, while the tool runs."""
    take, tool = find_take(context.scene), running()
    if take is None or tool is None:
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return
    for number, line in enumerate(tool.lines):
        _draw_line(view, line, number == tool.last, context.scene.frame_current)
        if line.kind == "HEIGHT":
            x, y = view.to_region(np.array(line.ends, dtype=np.float64)).mean(axis=0)
            words = f"{tool.length_of(line):.2f} m"
            drawing.text(words, float(x) + BESIDE_PX * drawing.ui_scale(), float(y), COLORS[line.kind])
    _draw_found(context, view, tool)


def _draw_line(view: FootageView, line: DrawnLine, active: bool, frame: int) -> None:
    there = 1.0 if line.kind != "HEIGHT" or line.frame == frame else ELSEWHERE
    color = drawing.faded(COLORS[line.kind], there)
    ends = view.to_region(np.array(line.ends, dtype=np.float64))
    drawing.lines(ends[None], color, width=2.5 if active else 1.5, halo=0.8 * there)
    half = END_PX * drawing.ui_scale() * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    drawing.polygons(ends[:, None] + half, color)


def _draw_found(context: bpy.types.Context, view: FootageView, tool: Drawing) -> None:
    """Write what the lines say of the camera at the lower edge of the picture."""
    left = max(0.0, float(view.top_left[0]))
    bottom = max(0.0, float((view.top_left + view.extent)[1]))
    scale = drawing.ui_scale()
    rows = _sentences(tool)
    for number, sentence in enumerate(reversed(rows)):
        drawing.text(sentence, left + MARGIN_PX * scale, bottom + (MARGIN_PX + ROW_PX * number) * scale)


def _sentences(tool: Drawing) -> list[str]:
    if tool.fit is None:
        return ["No line yet: the grid shows the camera as it is"]
    if not is_found(tool.fit):
        return ["This says nothing of the camera yet"]
    rows = [values(tool.fit), f"Lines are {tool.fit.misfit_px:.1f} px off"]
    return rows + [HINTS[name] for name in tool.fit.kept if name in ("height", "tilt", "roll")]
