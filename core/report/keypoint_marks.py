"""Keypoints over the footage: where each was seen, where the motion puts it, and which are not believed."""

from collections.abc import Callable

import numpy as np

from ..arrays import Array
from ..review.compared_keypoints import ComparedKeypoints
from .canvas import GRAY, WHITE, Canvas, Color
from .captions import ascii_text, truncated

SOURCE_COLORS: tuple[Color, ...] = ((167, 121, 204), (66, 228, 240), (233, 180, 86), (0, 159, 230))
"""Purple, yellow, sky blue and orange for the first sources, Okabe and Ito's beside those of the limbs."""
THROWN_OUT: Color = (40, 30, 200)
ARM = 3.4
"""Half-length of a cross's arms [px]; half of it for a small figure."""
RING = 2.2
"""Radius of the ring at the predicted place [px]; the same."""
LARGE = 220.0
"""Height of a figure whose marks are of full size [px]."""
LONGEST_SOURCE = 150.0
"""Width of a source's name in the legend [px]."""


def source_color(keypoints: ComparedKeypoints, source: str) -> Color:
    """The color of a source's keypoints."""
    index = list(dict.fromkeys(keypoints.sources)).index(source)
    return SOURCE_COLORS[index % len(SOURCE_COLORS)]


def draw_keypoints(
    canvas: Canvas, keypoints: ComparedKeypoints, frame: int, to_canvas: Callable[[Array], Array]
) -> None:
    """Draw the keypoints of one frame, the marks of a small figure smaller.

    Args:
        canvas: The canvas.
        keypoints: The keypoints.
        frame: Frame index in the clip.
        to_canvas: From pixels of the clip (N, 2) to points of the canvas.
    """
    seen, predicted = to_canvas(keypoints.seen[frame]), to_canvas(keypoints.predicted[frame])
    colors = [source_color(keypoints, source) for source in keypoints.sources]
    thrown_out, swapped = keypoints.thrown_out[frame], keypoints.swapped[frame]
    size = _size(predicted)
    for index, color in enumerate(colors):
        if not thrown_out[index]:
            canvas.line([seen[index], predicted[index]], color, 1.0)
    for place, color in zip(predicted, colors, strict=True):
        _ring(canvas, place, color, size)
    for index, color in enumerate(colors):
        if np.isfinite(seen[index]).all():
            _cross(canvas, seen[index], color, size, bool(thrown_out[index]), bool(swapped[index]))


def draw_keypoint_legend(
    canvas: Canvas, keypoints: ComparedKeypoints, left: float, right: float, y: float
) -> None:
    """Explain the marks on a line with its baseline at `y` that ends at `right`; nothing if it lacks room."""
    names = [
        truncated(ascii_text(source), LONGEST_SOURCE, 8.0) for source in dict.fromkeys(keypoints.sources)
    ]
    words = [("Cross: keypoint of", GRAY)]
    words += [(name, SOURCE_COLORS[index % len(SOURCE_COLORS)]) for index, name in enumerate(names)]
    words.append(("slanting: not believed; boxed: sides exchanged; ring: where the motion puts it", GRAY))
    x = right - sum(canvas.text_width(word, 8.0) + 8.0 for word, _ in words)
    if x < left:
        return
    for word, color in words:
        canvas.text(word, x, y, 8.0, color)
        x += canvas.text_width(word, 8.0) + 8.0


def _size(predicted: Array) -> float:
    """Size of the marks, from the height of the figure on the canvas."""
    rows = predicted[np.isfinite(predicted).all(axis=-1), 1]
    return float(np.clip(np.ptp(rows) / LARGE, 0.5, 1.0)) if len(rows) else 1.0


def _ring(canvas: Canvas, place: Array, color: Color, size: float) -> None:
    canvas.ring(place, size * RING, WHITE, 2.0)
    canvas.ring(place, size * RING, color, 1.0)


def _cross(canvas: Canvas, place: Array, color: Color, size: float, thrown_out: bool, swapped: bool) -> None:
    """An upright cross; a slanting one where it is thrown out, one in a square where sides are exchanged."""
    arms = size * ARM * (np.array([[0.7, 0.7], [0.7, -0.7]]) if thrown_out else np.eye(2))
    color = THROWN_OUT if thrown_out else color
    for width, ink in ((2.0, WHITE), (1.0, color)):
        for arm in arms:
            canvas.line([place - arm, place + arm], ink, width)
        if swapped:
            corners = place + 1.2 * size * ARM * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
            canvas.line(corners, ink, width, closed=True)
