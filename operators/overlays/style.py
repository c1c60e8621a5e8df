"""Style of the overlays: colors, sizes, dashes. All sizes are unscaled [px]."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...core.arrays import Array
from ...core.body.side_colors import LIGHT, Rgb, side_of
from .drawing import Color, faded


def _opaque(rgb: Rgb) -> Color:
    red, green, blue = (level / 255.0 for level in rgb)
    return (red, green, blue, 1.0)


SIDES: Mapping[str, Color] = {side: _opaque(rgb) for side, rgb in LIGHT.items()}
LEFT, RIGHT, MIDDLE = SIDES["L"], SIDES["R"], SIDES[""]
"""Colors of the performer's sides, and of what has none."""
CORE: Color = (0.08, 0.08, 0.08, 1.0)
"""Color of the core of a hollow line."""
SOURCES: tuple[Color, ...] = (
    (0.90, 0.55, 0.78, 1.0),
    (0.94, 0.89, 0.26, 1.0),
    (0.20, 0.80, 0.62, 1.0),
    (0.72, 0.62, 0.98, 1.0),
)
"""Colors of keypoints by their source: purple, yellow, green and violet, none of them a side's."""
THROWN_OUT: Color = (1.0, 0.25, 0.2, 1.0)
"""Color of keypoints that are not believed."""
DASH, GAP = 6.0, 4.0
JOINT, DOT, DIAMOND = 3.5, 1.4, 5.0
CORE_SHARE = 0.45
"""Thickness of the core of a hollow line, as a share of the line's."""
CANDIDATE_COLORS = 8
"""Colors of collections that Blender's themes have, with an icon each: those of a frame's candidates."""
GHOST = 0.6
"""Opacity of figures that are only offered."""
LIMB = 2.4
"""Thickness of limbs relative to outlines."""
METER, SMALLEST = 160.0, 0.35
"""Size of a meter below which a body's marks get smaller [px], and the smallest share of their size."""
PALER = 0.5
"""Share of white in the prediction's color, so that dashes show over a solid line."""
HALO = 0.9
UNCERTAIN_M = 0.05
"""Standard deviation above which a point is drawn as a ring within a circle of that size [m]."""
PATH_POINTS = ("wrist.L", "wrist.R", "ankle.L", "ankle.R")
PATH_FRAMES = 15
"""Frames of a path before the current one, and after it."""


@dataclass(frozen=True)
class Style:
    """The animator's opacity, and the scales of screen and body."""

    width: ClassVar[float] = 1.5
    """Thickness of lines."""
    opacity: float
    scale: float
    """Screen pixels for each unscaled pixel."""
    body_scale: float = 1.0
    """Scale of the body's marks, below 1 for a distant body."""

    def color(self, color: Color | tuple[float, float, float]) -> Color:
        """A color with the chosen opacity."""
        return faded(color, self.opacity)

    def size(self, plain: float) -> float:
        """A size of the body's marks [region px]."""
        return plain * self.body_scale * self.scale

    @property
    def halo(self) -> float:
        """Opacity of lines' dark edges."""
        return HALO * self.opacity


def body_scale(pixels_per_meter: Array, scale: float) -> float:
    """Scale of a body's marks from the size of a meter at each of its points (N,) [region px]."""
    seen = pixels_per_meter[np.isfinite(pixels_per_meter)]
    meter = float(np.median(seen)) / scale if len(seen) else METER
    return float(np.clip(meter / METER, SMALLEST, 1.0))


def candidate_icon(index: int) -> str:
    """Icon in a candidate's color."""
    return f"COLLECTION_COLOR_{index % CANDIDATE_COLORS + 1:02d}"


def side_color(name: str) -> Color:
    """The color of a point by the side of the body in its name."""
    return SIDES[side_of(name)]


def paler(color: tuple[float, float, float]) -> tuple[float, float, float]:
    """A color nearer to white."""
    red, green, blue = (PALER + (1.0 - PALER) * np.asarray(color, dtype=np.float64)).tolist()
    return (red, green, blue)
