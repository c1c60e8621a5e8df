"""The brush over the footage: its strokes while it is at work, for the operator and for the overlay."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...core.footage.ignored_regions import IgnoredRegion

Pixel = tuple[float, float]

STEP = 0.25
"""Distance between points of a stroke, in radii: more would not be seen."""
GROWTH = 1.25
"""Factor between sizes of the brush."""
USUAL = 0.03
"""The first radius as a share of the picture's width."""
SMALLEST_PX, LARGEST = 1.0, 0.5
"""The smallest radius, and the largest one as a share of the picture's width."""


@dataclass
class Brush:
    """A brush at work."""

    width: int
    """Width of the footage in px."""
    radius_px: float = 0.0
    """Its radius in pixels of the footage; 0 for the usual one."""
    strokes: "list[tuple[float, list[Pixel]]]" = field(default_factory=list)
    """Radius and points of each stroke."""
    is_down: bool = False

    def __post_init__(self) -> None:
        """Begin with the usual size."""
        self.radius_px = self.radius_px or max(USUAL * self.width, SMALLEST_PX)

    def press(self, pixel: Pixel) -> None:
        """Begin a stroke."""
        self.strokes.append((self.radius_px, [pixel]))
        self.is_down = True

    def move(self, pixel: Pixel, most_points: int) -> None:
        """Go on with the stroke; a long one goes on as another."""
        radius, points = self.strokes[-1]
        if np.hypot(pixel[0] - points[-1][0], pixel[1] - points[-1][1]) < STEP * radius:
            return
        if len(points) >= most_points:
            self.strokes.append((radius, [points[-1]]))
        self.strokes[-1][1].append(pixel)

    def grow(self, steps: int) -> None:
        """Make it larger, or smaller with fewer than no steps."""
        self.radius_px = float(np.clip(self.radius_px * GROWTH**steps, SMALLEST_PX, LARGEST * self.width))

    def regions(self) -> "tuple[IgnoredRegion, ...]":
        """What was brushed."""
        from ...core.footage.ignored_regions import IgnoredRegion

        return tuple(IgnoredRegion(stroke=tuple(points), radius_px=radius) for radius, points in self.strokes)


_brush: Brush | None = None


def take_brush(brush: Brush | None) -> None:
    """Set the brush that is at work; None for none."""
    global _brush
    _brush = brush


def brush_at_work() -> Brush | None:
    """The brush that is at work; None for none."""
    return _brush
