"""The demonstration of presets/demo."""

from .. import aerobic
from ..described import Described
from ..viewpoint import look_at
from .sizes import SMALL

DEMONSTRATION = Described(
    name="aerobic",
    perform=aerobic.perform,
    camera=look_at((0.75, -4.15, 1.32), (0.24, 0.05, 1.03), 47.0, SMALL),
    side=look_at((4.35, -0.25, 1.25), (0.1, -0.15, 1.03), 47.0, SMALL),
    keyframes=tuple(frame - 1 for frame in (1, 9, 16, 24, 31, 43, 54, 67, 81, 95, 107, 118)),
    postures=True,
    detected=True,
    samples=3,
)
"""Its keyframes are an animator's choice: ends of movements, and midpoints where these are far apart."""
