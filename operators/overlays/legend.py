"""Legend in a corner of a region."""

from enum import Enum
from functools import lru_cache

import numpy as np
from bpy.types import Area, Region

from . import drawing
from .drawing import Color, Fill, Item, Label, Stroke, Style, text_size
from .figures import SLANTING, UPRIGHT, circles, dashes, diamonds, segments, squares

GROUND = (0.0, 0.0, 0.0, 0.35)
SAMPLE, GAP_AFTER, LINE, MARGIN = 26.0, 8.0, 18.0, 12.0
"""Length of a sample, distance to its text, height of a line, distance from the corner [px]."""
VIEW_NAME = 40.0  # height of Blender's two lines on the view in the same corner [px]
THIN, THICK = 1.5, 3.6


class Sample(Enum):
    """The sample at the start of a row: its figure, none where empty, and its color."""

    NONE = "", drawing.MIDDLE
    SOLID = "line", drawing.MIDDLE
    DASHED = "dashed line", drawing.MIDDLE
    PAST = "dotted line", drawing.MIDDLE
    FUTURE = "dashed dotted line", drawing.MIDDLE
    LEFT = "limb", drawing.LEFT
    RIGHT = "hollow limb", drawing.RIGHT
    RING = EXPECTED = "ring", drawing.MIDDLE
    DIAMOND = "diamond", drawing.MIDDLE
    SOURCE_1 = "cross", drawing.SOURCES[0]
    SOURCE_2 = "cross", drawing.SOURCES[1]
    SOURCE_3 = "cross", drawing.SOURCES[2]
    SOURCE_4 = "cross", drawing.SOURCES[3]
    THROWN_OUT = "slanting cross", drawing.THROWN_OUT
    SWAPPED = "framed cross", drawing.MIDDLE


SOURCE_SAMPLES = (Sample.SOURCE_1, Sample.SOURCE_2, Sample.SOURCE_3, Sample.SOURCE_4)
"""Samples of keypoints by the order of their sources."""

Row = tuple[Sample, str]


@lru_cache(maxsize=16)
def legend(rows: tuple[Row, ...], x: float, y: float, style: Style) -> tuple[Item, ...]:
    """A legend of rows on a dark ground; x is the left end of samples, y the upper end of the first."""
    if not rows:
        return ()
    strokes: list[Stroke] = []
    fills: list[Fill] = []
    labels: list[Label] = []
    y -= len(rows) * LINE * style.scale
    for row, (sample, words) in enumerate(reversed(rows)):
        base = y + row * LINE * style.scale
        drawn = _sample(*sample.value, x, base + 4.0 * style.scale, style)  # the letters' middle
        strokes += [item for item in drawn if isinstance(item, Stroke)]
        fills += [item for item in drawn if isinstance(item, Fill)]
        indent = (SAMPLE + GAP_AFTER) * style.scale if drawn else 0.0
        labels.append(Label(words, x + indent, base))
    edge = 0.5 * MARGIN * style.scale
    right = max(label.x + text_size(label.words)[0] for label in labels) + edge
    left, bottom, top = x - edge, y - edge, labels[-1].y + LINE * style.scale
    ground = np.array([[[left, bottom], [right, bottom], [right, top], [left, top]]])
    # Thick lines below thin ones, and items of one kind together, so that few draw calls are needed.
    strokes.sort(key=lambda stroke: -stroke.width)
    return (Fill(ground, style.color(GROUND)), *strokes, *fills, *labels)


def _sample(figure: str, color: Color, x: float, y: float, style: Style) -> list[Item]:
    color, scale = style.color(color), style.scale
    line = np.array([[x, y], [x + SAMPLE * scale, y]])
    middle = line.mean(axis=0, keepdims=True)
    thin, fills = [], []
    if "limb" in figure:
        core = Stroke(line[None], style.color(drawing.CORE), style.core * THICK)
        return [Stroke(line[None], color, THICK, style.halo), *([core] if "hollow" in figure else [])]
    if "ring" in figure:
        thin.append(segments(circles(middle, style.joint * scale, 16), closed=True))
    if "cross" in figure:
        arms = style.joint * scale * (SLANTING if "slanting" in figure else UPRIGHT)
        thin.append(middle + np.stack([-arms, arms], axis=1))
    if "framed" in figure:
        thin.append(segments(squares(middle, 1.1 * style.joint * scale), closed=True))
    if "diamond" in figure:
        fills.append(diamonds(middle, style.diamond * scale))
        thin.append(segments(fills[0], closed=True))
    if "line" in figure:
        dashed = dashes(line, style.dash * scale, style.gap * scale)
        thin.append(dashed if "dashed" in figure else line[None])
    if "dotted" in figure:
        fills.append(circles(np.linspace(line[0], line[1], 5)[1:-1], (style.dot + 1.0) * scale, 8))
    strokes = [Stroke(parts, color, THIN, style.halo) for parts in thin]
    return [*strokes, *(Fill(corners, color) for corners in fills)]


def corner(area: Area, region: Region, scale: float) -> tuple[float, float]:
    """The top left corner of what nothing covers in a region [px]; below, the performer's feet would be."""
    left, top = 0.0, float(region.height)
    for other in area.regions:
        covers = other.width > 1 and other.height > 1 and other != region
        if covers and other.alignment == "LEFT":
            left = max(left, float(other.x + other.width - region.x))
        elif covers and other.alignment == "TOP" and other.y < region.y + region.height:
            top = min(top, float(other.y - region.y))
    return left + MARGIN * scale, top - (MARGIN + VIEW_NAME) * scale
