"""Outlines of marker regions: observed ones solid, predicted ones dashed, as are contours of the body."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Array
from .drawing import INK
from .figures import dashes, segments
from .picture import Item, Label, Stroke
from .style import DASH, GAP, MIDDLE, Style, paler

if TYPE_CHECKING:
    from ...core.review.review import Review

MarkerColor = tuple[float, float, float]


def hidden_markers(review: "Review", index: int) -> list[int]:
    """Indices of the markers that were not found in a frame."""
    return np.flatnonzero(~np.isfinite(review.observed[index]).all(axis=-1).any(axis=-1)).tolist()


def observed_outlines(
    review: "Review",
    index: int,
    to_region: Callable[[Array], Array],
    colors: list[MarkerColor],
    style: Style,
) -> list[Item]:
    """A solid outline of each region that was found.

    Args:
        review: The review of the motion.
        index: Index of the frame.
        to_region: Converts footage pixels (..., 2) to region pixels.
        colors: Each marker's color.
        style: Colors and sizes.
    """
    outlines = to_region(review.observed[index])
    return [
        Stroke(segments(outline, closed=True), style.color(color), style.width, style.halo)
        for outline, color in zip(outlines, colors, strict=True)
    ]


def predicted_outlines(
    review: "Review",
    index: int,
    to_region: Callable[[Array], Array],
    colors: list[MarkerColor],
    style: Style,
) -> list[Item]:
    """A dashed, paler outline of each region that the motion predicts; that of a hidden marker is named."""
    outlines = to_region(review.predicted[index])
    items: list[Item] = []
    hidden = hidden_markers(review, index)
    for marker, (outline, color) in enumerate(zip(outlines, colors, strict=True)):
        whole = outline[np.isfinite(outline).all(axis=-1)]
        if not len(whole):
            continue
        parts = dashes(whole, DASH * style.scale, GAP * style.scale, closed=True)
        items.append(Stroke(parts, style.color(paler(color)), style.width, style.halo))
        if marker in hidden:
            x, y = whole[:, 0].max() + GAP * style.scale, whole[:, 1].mean()
            words = f"{review.marker_names[marker]} hidden"
            items.append(Label(words, float(x), float(y), style.color(INK)))
    return items


def predicted_contours(
    review: "Review", index: int, to_region: Callable[[Array], Array], style: Style
) -> list[Item]:
    """The contour lines of the body that the motion predicts, dashed."""
    lines = to_region(review.contours[index])
    parts = [dashes(line, DASH * style.scale, GAP * style.scale) for line in lines]
    return [Stroke(np.concatenate(parts), style.color(MIDDLE), style.width, style.halo)] if parts else []
