"""The ways of points through time: past solid, future dashed, a dot a frame, diamonds at keyframes."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from .figures import circles, dashes, diamonds, segments
from .picture import Fill, Item, Stroke
from .style import DASH, DIAMOND, DOT, GAP, MIDDLE, Style, side_color

Array = NDArray[np.float64]


def window(index: int, before: int, after: int, frame_count: int) -> NDArray[np.intp]:
    """Places of the frames from `before` ones before to `after` ones after one, within the clip."""
    return np.arange(max(0, index - before), min(frame_count, index + after + 1))


def path(
    name: str,
    places: Array,
    frames: NDArray[np.intp],
    index: int,
    keyframe_indices: Iterable[int],
    style: Style,
) -> list[Item]:
    """The way of one point.

    Args:
        name: The point's name.
        places: (I, 2) where it is in the region in each frame of the window.
        frames: (I,) those frames' places in the clip.
        index: The current frame's place in the clip.
        keyframe_indices: Those of the keyframes.
        style: How to draw.
    """
    color = style.color(side_color(name))
    past, future = places[frames <= index], places[frames >= index]
    ahead = dashes(future, DASH * style.scale, GAP * style.scale)
    seen = np.isfinite(places).all(axis=-1)
    keyed = np.isin(frames, list(keyframe_indices)) & seen
    marks = diamonds(places[keyed], style.size(DIAMOND))
    return [
        Stroke(segments(past), color, style.width, style.halo),
        Stroke(ahead, color, style.width, style.halo),
        Fill(circles(places[seen & ~keyed], style.size(DOT + 0.5 * style.width), 8), style.color(MIDDLE)),
        Stroke(segments(marks, closed=True), color, 1.5, style.halo),
        Fill(marks, color),
    ]
