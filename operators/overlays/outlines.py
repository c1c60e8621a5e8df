"""Outlines of marker regions, observed ones solid and predicted ones dashed, and paths of points."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Array, IndexArray
from .drawing import (
    INK,
    MIDDLE,
    PATH_FRAMES,
    Fill,
    Item,
    Label,
    Stroke,
    Style,
    paler,
    side_color,
)
from .figures import circles, dashes, diamonds, segments

if TYPE_CHECKING:
    from ...core.review.review import Review


MarkerColor = tuple[float, float, float]


def hidden_markers(review: "Review", index: int) -> list[int]:
    """Indices of the markers that were not found in a frame."""
    return np.flatnonzero(~np.isfinite(review.observed[index]).all(axis=-1).any(axis=-1)).tolist()


def observed_outlines(
    review: "Review", index: int, to_region: Callable[[Array], Array], colors: list[MarkerColor], style: Style
) -> list[Item]:
    """A solid outline of each region that was found."""
    outlines = to_region(review.observed[index])
    return [
        Stroke(segments(outline, closed=True), style.color(color), style.width, style.halo)
        for outline, color in zip(outlines, colors, strict=True)
    ]


def predicted_outlines(
    review: "Review", index: int, to_region: Callable[[Array], Array], colors: list[MarkerColor], style: Style
) -> list[Item]:
    """A dashed, paler outline of each region that the motion predicts; that of a hidden marker is named."""
    outlines = to_region(review.predicted[index])
    items: list[Item] = []
    hidden = hidden_markers(review, index)
    for marker, (outline, color) in enumerate(zip(outlines, colors, strict=True)):
        whole = outline[np.isfinite(outline).all(axis=-1)]
        if not len(whole):
            continue
        parts = dashes(whole, style.dash * style.scale, style.gap * style.scale, closed=True)
        items.append(Stroke(parts, style.color(paler(color)), style.width, style.halo))
        if marker in hidden:
            x, y = whole[:, 0].max() + style.gap * style.scale, whole[:, 1].mean()
            words = f"{review.marker_names[marker]} hidden"
            items.append(Label(words, float(x), float(y), style.color(INK)))
    return items


def predicted_contours(
    review: "Review", index: int, to_region: Callable[[Array], Array], style: Style
) -> list[Item]:
    """The contour lines of the body that the motion predicts, dashed."""
    lines = to_region(review.contours[index])
    parts = [dashes(line, style.dash * style.scale, style.gap * style.scale) for line in lines]
    return [Stroke(np.concatenate(parts), style.color(MIDDLE), style.width, style.halo)] if parts else []


# --- Paths of points over time


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
    """The paths of N points: `positions` (N, I, 2) at the clip's `frames` (I,), about the frame `index`."""
    keyed = np.isin(frames, keyframe_indices)
    dots, marks = positions[:, ~keyed].reshape(-1, 2), positions[:, keyed]
    items: list[Item] = []
    for name, path in zip(names, positions, strict=True):
        color = style.color(side_color(name))
        ahead = dashes(path[frames >= index], style.dash * style.scale, style.gap * style.scale)
        items.append(Stroke(segments(path[frames <= index]), color, style.width, style.halo))
        items.append(Stroke(ahead, color, style.width, style.halo))
    items.append(Fill(circles(dots, style.size(style.dot + 0.5 * style.width), 8), style.color(MIDDLE)))
    # All edges, then all diamonds: alike neighbors are drawn in one call.
    corners = [diamonds(mark, style.size(style.diamond)) for mark in marks]
    colors = [style.color(side_color(name)) for name in names]
    pairs = list(zip(corners, colors, strict=True))
    items += [Stroke(segments(mark, closed=True), color, 1.5, style.halo) for mark, color in pairs]
    items += [Fill(mark, color) for mark, color in pairs]
    return items
