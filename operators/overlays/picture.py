"""Items of an overlay as data: made without a screen, painted in few draw calls."""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ...core.arrays import Array
from . import drawing
from .drawing import Color


@dataclass(frozen=True, eq=False)
class Stroke:
    """Straight lines."""

    segments: Array
    """(S, 2, 2) region pixels."""
    color: ArrayLike
    """(4,) for all, or (S, 4)."""
    width: float
    halo: float = 0.0
    """Opacity of the dark edge."""


@dataclass(frozen=True, eq=False)
class Fill:
    """Filled convex polygons."""

    corners: Array
    """(N, K, 2) region pixels."""
    color: ArrayLike
    """(4,) for all, or (N, 4)."""


@dataclass(frozen=True)
class Label:
    """A line of text; `x` is the position of the part that `align` names, `y` the base line [region px]."""

    words: str
    x: float
    y: float
    color: Color = drawing.INK
    align: Literal["left", "middle", "right"] = "left"


Item = Stroke | Fill | Label


def paint(items: Iterable[Item]) -> None:
    """Draw all items, the first at the bottom; alike neighbors in one draw call."""
    for item in merged(items):
        if isinstance(item, Stroke):
            drawing.lines(item.segments, item.color, item.width, item.halo)
        elif isinstance(item, Fill):
            drawing.polygons(item.corners, item.color)
        else:
            drawing.text(item.words, item.x, item.y, item.color, align=item.align)


def merged(items: Iterable[Item]) -> list[Item]:
    """Merge neighboring lines of one thickness, and neighboring polygons of equally many corners."""
    done: list[Item] = []
    for _, group in groupby(items, key=_kind):
        alike = list(group)
        first = alike[0]
        if isinstance(first, Stroke) and len(alike) > 1:
            parts = [(item.segments, item.color) for item in alike if isinstance(item, Stroke)]
            done.append(Stroke(*_joined(parts), first.width, first.halo))
        elif isinstance(first, Fill) and len(alike) > 1:
            done.append(
                Fill(*_joined([(item.corners, item.color) for item in alike if isinstance(item, Fill)]))
            )
        else:
            done += alike
    return done


def _kind(item: Item) -> tuple[object, ...]:
    if isinstance(item, Stroke):
        return ("stroke", item.width, item.halo)
    return ("fill", item.corners.shape[-2]) if isinstance(item, Fill) else ("label",)


def _joined(parts: list[tuple[Array, ArrayLike]]) -> tuple[Array, Array]:
    """Concatenated points, and a color for each."""
    points = np.concatenate([part for part, _ in parts])
    colors = [np.broadcast_to(np.asarray(color, dtype=np.float64), (len(part), 4)) for part, color in parts]
    return points, np.concatenate(colors)
