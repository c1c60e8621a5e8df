"""Paths of points over time: past solid, future dashed, a dot for each frame, diamonds at keyframes."""

from collections.abc import Sequence

import numpy as np

from ...core.arrays import Array, IndexArray
from .figures import circles, dashes, diamonds, segments
from .picture import Fill, Item, Stroke
from .style import DASH, DIAMOND, DOT, GAP, MIDDLE, PATH_FRAMES, Style, side_color


def window(index: int, frame_count: int) -> IndexArray:
    """Indices of a path's frames about one, within the clip."""
    return np.arange(max(0, index - PATH_FRAMES), min(frame_count, index + PATH_FRAMES + 1))


def paths(
    names: Sequence[str],
    positions: Array,
    frames: IndexArray,
    index: int,
    keyframe_indices: IndexArray,
    style: Style,
) -> list[Item]:
    """The paths of N points.

    Args:
        names: The points' names.
        positions: (N, I, 2) their region pixels in each frame of the window.
        frames: (I,) indices of those frames in the clip.
        index: Index of the current frame in the clip.
        keyframe_indices: Indices of the keyframes.
        style: Colors and sizes.
    """
    keyed = np.isin(frames, keyframe_indices)
    dots, marks = positions[:, ~keyed].reshape(-1, 2), positions[:, keyed]
    items: list[Item] = []
    for name, path in zip(names, positions, strict=True):
        color = style.color(side_color(name))
        ahead = dashes(path[frames >= index], DASH * style.scale, GAP * style.scale)
        items.append(Stroke(segments(path[frames <= index]), color, style.width, style.halo))
        items.append(Stroke(ahead, color, style.width, style.halo))
    items.append(Fill(circles(dots, style.size(DOT + 0.5 * style.width), 8), style.color(MIDDLE)))
    # All edges, then all diamonds: alike neighbors are drawn in one call.
    corners = [diamonds(mark, style.size(DIAMOND)) for mark in marks]
    colors = [style.color(side_color(name)) for name in names]
    pairs = list(zip(corners, colors, strict=True))
    items += [Stroke(segments(mark, closed=True), color, 1.5, style.halo) for mark, color in pairs]
    items += [Fill(mark, color) for mark, color in pairs]
    return items
