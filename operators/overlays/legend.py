"""Legend in a corner of a region."""

from enum import Enum
from functools import lru_cache

import bpy
import numpy as np

from ...core.arrays import Array
from .drawing import (
    CORE,
    LEFT,
    MIDDLE,
    RIGHT,
    SOURCES,
    THROWN_OUT,
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


class Sample(Enum):
    """The sample at the start of a row."""

    NONE = "none"
    SOLID = "solid"
    DASHED = "dashed"
    PAST = "past"
    FUTURE = "future"
    LEFT = "left"
    RIGHT = "right"
    RING = "ring"
    DIAMOND = "diamond"
    SOURCE_1 = "first source"
    SOURCE_2 = "second source"
    SOURCE_3 = "third source"
    SOURCE_4 = "fourth source"
    EXPECTED = "expected"
    THROWN_OUT = "thrown out"
    SWAPPED = "swapped"


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
        drawn = _sample(sample, x, base + 4.0 * style.scale, style)  # the letters' middle
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


def _sample(sample: Sample, x: float, y: float, style: Style) -> list[Item]:
    color = style.color(MIDDLE)
    line = np.array([[x, y], [x + SAMPLE * style.scale, y]])
    middle = line.mean(axis=0, keepdims=True)
    whole = line[None]
    if sample in (Sample.LEFT, Sample.RIGHT):
        limb = Stroke(whole, style.color(LEFT if sample is Sample.LEFT else RIGHT), THICK, style.halo)
        core = Stroke(whole, style.color(CORE), style.core * THICK)
        return [limb] if sample is Sample.LEFT else [limb, core]
    if sample in (Sample.RING, Sample.EXPECTED):
        rim = segments(circles(middle, style.joint * style.scale, 16), closed=True)
        return [Stroke(rim, color, THIN, style.halo)]
    if sample in (*SOURCE_SAMPLES, Sample.THROWN_OUT, Sample.SWAPPED):
        return _keypoint_sample(sample, middle[0], style)
    if sample is Sample.DIAMOND:
        marks = diamonds(middle, style.diamond * style.scale)
        return [Stroke(segments(marks, closed=True), color, THIN, style.halo), Fill(marks, color)]
    if sample is Sample.NONE:
        return []
    dashed = sample in (Sample.DASHED, Sample.FUTURE)
    parts = dashes(line, style.dash * style.scale, style.gap * style.scale) if dashed else whole
    items: list[Item] = [Stroke(parts, color, THIN, style.halo)]
    if sample in (Sample.PAST, Sample.FUTURE):
        dots = np.linspace(line[0], line[1], 5)[1:-1]
        items.append(Fill(circles(dots, (style.dot + 1.0) * style.scale, 8), color))
    return items


def _keypoint_sample(sample: Sample, middle: Array, style: Style) -> list[Item]:
    color = style.color(THROWN_OUT if sample is Sample.THROWN_OUT else MIDDLE)
    if sample in SOURCE_SAMPLES:
        color = style.color(SOURCES[SOURCE_SAMPLES.index(sample)])
    arms = style.joint * style.scale * (SLANTING if sample is Sample.THROWN_OUT else UPRIGHT)
    items: list[Item] = [Stroke(middle + np.stack([-arms, arms], axis=1), color, THIN, style.halo)]
    if sample is Sample.SWAPPED:
        square = squares(middle[None], 1.1 * style.joint * style.scale)
        items.append(Stroke(segments(square, closed=True), color, THIN, style.halo))
    return items


def corner(area: bpy.types.Area, region: bpy.types.Region, scale: float) -> tuple[float, float]:
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
