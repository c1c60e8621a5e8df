"""Legend in a corner of a region."""

from dataclasses import dataclass
from enum import Enum
from functools import lru_cache

import numpy as np
from bpy.types import Area, Region

from ...core.arrays import Array
from .drawing import (
    CORE,
    LEFT,
    MIDDLE,
    RIGHT,
    SOURCES,
    THROWN_OUT,
    Color,
    Fill,
    Item,
    Label,
    Stroke,
    Style,
    text_size,
)
from .figures import SLANTING, UPRIGHT, circles, dashes, diamonds, segments, squares

GROUND = (0.0, 0.0, 0.0, 0.35)
SAMPLE, GAP_AFTER, LINE, MARGIN = 26.0, 8.0, 18.0, 12.0
"""Length of a sample, distance to its text, height of a line, distance from the corner [px]."""
VIEW_NAME = 40.0  # height of Blender's two lines on the view in the same corner [px]
THIN, THICK = 1.5, 3.6


@dataclass(frozen=True)
class Look:
    """What a sample looks like."""

    figure: str = ""  # line, limb, ring, cross or diamond; empty for none
    color: Color = MIDDLE
    dashed: bool = False
    dotted: bool = False
    hollow: bool = False
    slanting: bool = False
    framed: bool = False


class Sample(Enum):
    """The sample at the start of a row."""

    NONE = Look()
    SOLID = Look("line")
    DASHED = Look("line", dashed=True)
    PAST = Look("line", dotted=True)
    FUTURE = Look("line", dashed=True, dotted=True)
    LEFT = Look("limb", LEFT)
    RIGHT = Look("limb", RIGHT, hollow=True)
    RING = EXPECTED = Look("ring")
    DIAMOND = Look("diamond")
    SOURCE_1 = Look("cross", SOURCES[0])
    SOURCE_2 = Look("cross", SOURCES[1])
    SOURCE_3 = Look("cross", SOURCES[2])
    SOURCE_4 = Look("cross", SOURCES[3])
    THROWN_OUT = Look("cross", THROWN_OUT, slanting=True)
    SWAPPED = Look("cross", framed=True)


SOURCE_SAMPLES = (Sample.SOURCE_1, Sample.SOURCE_2, Sample.SOURCE_3, Sample.SOURCE_4)
"""Samples of keypoints by the order of their sources."""

Row = tuple[Sample, str]


@lru_cache(maxsize=16)
def legend(rows: tuple[Row, ...], x: float, y: float, style: Style) -> tuple[Item, ...]:
    """A legend on a dark background, which sets it off from bright footage.

    Rows are from the top down; x is the left end of the samples, y the upper end of the first row.
    """
    if not rows:
        return ()
    strokes: list[Stroke] = []
    fills: list[Fill] = []
    labels: list[Label] = []
    y -= len(rows) * LINE * style.scale
    for row, (sample, words) in enumerate(reversed(rows)):
        base = y + row * LINE * style.scale
        drawn = _sample(sample.value, x, base + 4.0 * style.scale, style)  # the letters' middle
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


def _sample(look: Look, x: float, y: float, style: Style) -> list[Item]:
    color, scale = style.color(look.color), style.scale
    line = np.array([[x, y], [x + SAMPLE * scale, y]])
    middle = line.mean(axis=0, keepdims=True)

    def thin(parts: Array) -> Stroke:
        return Stroke(parts, color, THIN, style.halo)

    if look.figure == "limb":
        core = Stroke(line[None], style.color(CORE), style.core * THICK)
        return [Stroke(line[None], color, THICK, style.halo), *([core] if look.hollow else [])]
    if look.figure == "ring":
        return [thin(segments(circles(middle, style.joint * scale, 16), closed=True))]
    if look.figure == "cross":
        arms = style.joint * scale * (SLANTING if look.slanting else UPRIGHT)
        square = segments(squares(middle, 1.1 * style.joint * scale), closed=True)
        return [thin(middle + np.stack([-arms, arms], axis=1)), *([thin(square)] if look.framed else [])]
    if look.figure == "diamond":
        marks = diamonds(middle, style.diamond * scale)
        return [thin(segments(marks, closed=True)), Fill(marks, color)]
    if look.figure == "line":
        dots = circles(np.linspace(line[0], line[1], 5)[1:-1], (style.dot + 1.0) * scale, 8)
        drawn = dashes(line, style.dash * scale, style.gap * scale) if look.dashed else line[None]
        return [thin(drawn), *([Fill(dots, color)] if look.dotted else [])]
    return []


def corner(area: Area, region: Region, scale: float) -> tuple[float, float]:
    """The top left corner of a region's part that no toolbar, header or name of the view covers [region px].

    Below, where a legend would lie as well, the performer's feet are.
    """
    left, top = 0.0, float(region.height)
    for other in area.regions:
        covers = other.width > 1 and other.height > 1 and other != region
        if covers and other.alignment == "LEFT":
            left = max(left, float(other.x + other.width - region.x))
        elif covers and other.alignment == "TOP" and other.y < region.y + region.height:
            top = min(top, float(other.y - region.y))
    return left + MARGIN * scale, top - (MARGIN + VIEW_NAME) * scale
