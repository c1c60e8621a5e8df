"""The ways of points through time: past solid, future dashed, a dot a frame, diamonds at keyframes."""

from collections.abc import Sequence

import numpy as np

from ...core.arrays import Array, IndexArray
from .figures import circles, dashes, diamonds, segments
from .picture import Fill, Item, Stroke
from .style import DASH, DIAMOND, DOT, GAP, MIDDLE, Style, side_color


def window(index: int, before: int, after: int, frame_count: int) -> IndexArray:
    """Places of the frames from `before` ones before to `after` ones after one, within the clip."""
    return np.arange(max(0, index - before), min(frame_count, index + after + 1))


def paths(
    names: Sequence[str],
    places: Array,
    frames: IndexArray,
    index: int,
    keyframe_indices: IndexArray,
    style: Style,
) -> list[Item]:
    """The ways of N points.

    Args:
        names: The points' names.
        places: (N, I, 2) where they are in the region in each frame of the window.
        frames: (I,) those frames' places in the clip.
        index: The current frame's place in the clip.
        keyframe_indices: Those of the keyframes.
        style: How to draw.
    """
    keyed = np.isin(frames, keyframe_indices)
    dots, marks = places[:, ~keyed].reshape(-1, 2), places[:, keyed]
    items: list[Item] = []
    for name, way in zip(names, places, strict=True):
        color = style.color(side_color(name))
        ahead = dashes(way[frames >= index], DASH * style.scale, GAP * style.scale)
        items.append(Stroke(segments(way[frames <= index]), color, style.width, style.halo))
        items.append(Stroke(ahead, color, style.width, style.halo))
    items.append(Fill(circles(dots, style.size(DOT + 0.5 * style.width), 8), style.color(MIDDLE)))
    for name, mark in zip(names, marks, strict=True):
        color = style.color(side_color(name))
        corners = diamonds(mark, style.size(DIAMOND))
        items.append(Stroke(segments(corners, closed=True), color, 1.5, style.halo))
        items.append(Fill(corners, color))
    return items
