"""What an overlay consists of, as data: made without a screen, painted in one go."""

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
    """(4,) one for all, or (S, 4)."""
    width: float
    halo: float = 0.0
    """Opacity of the dark edge."""


@dataclass(frozen=True, eq=False)
class Fill:
    """Filled convex polygons."""

    corners: Array
    """(N, K, 2) region pixels."""
    color: ArrayLike
    """(4,) one for all, or (N, 4)."""


@dataclass(frozen=True)
class Label:
    """A line of words; `x` is where its `align` part stands, `y` the base line [region px]."""

    words: str
    x: float
    y: float
    color: Color = drawing.INK
    align: Literal["left", "middle", "right"] = "left"


Item = Stroke | Fill | Label


def paint(items: Iterable[Item]) -> None:
    """Draw everything, the first at the bottom; neighbors that are alike in one go."""
    for item in merged(items):
        if isinstance(item, Stroke):
            drawing.lines(item.segments, item.color, item.width, item.halo)
        elif isinstance(item, Fill):
            drawing.polygons(item.corners, item.color)
        else:
            drawing.text(item.words, item.x, item.y, item.color, align=item.align)


def merged(items: Iterable[Item]) -> list[Item]:
    """Neighboring lines of one thickness become one item, and neighboring polygons of as many corners."""
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
    """Places one after the other, and a color for each."""
    places = np.concatenate([place for place, _ in parts])
    colors = [np.broadcast_to(np.asarray(color, dtype=np.float64), (len(place), 4)) for place, color in parts]
    return places, np.concatenate(colors)
