"""What an overlay consists of, as data: made without a screen, painted in one go."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import drawing
from .drawing import Color

Array = NDArray[np.float64]


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
    """Draw everything, the first at the bottom."""
    for item in items:
        if isinstance(item, Stroke):
            drawing.lines(item.segments, item.color, item.width, item.halo)
        elif isinstance(item, Fill):
            drawing.polygons(item.corners, item.color)
        else:
            drawing.text(item.words, item.x, item.y, item.color, align=item.align)
