"""Appearance of a performer: colors, girths and garments."""

from collections.abc import Mapping
from dataclasses import dataclass, field

Color = tuple[int, int, int]

CLOTHES: dict[str, Color] = {
    "trunk": (44, 92, 200),
    "forearm.L": (214, 44, 52),
    "forearm.R": (52, 166, 78),
    "shin.L": (232, 190, 44),
    "shin.R": (178, 52, 156),
    "skin": (206, 154, 126),
    "cloth": (52, 53, 58),
    "hair": (58, 42, 34),
    "shoe": (206, 206, 202),
    "eye": (40, 30, 28),
    "sleeve": (52, 53, 58),
}
"""Painted colors (sRGB), before light and camera."""
MARKERS = tuple(CLOTHES)[:5]
CLOTH_M = {"trunk": 0.005, "forearm": 0.003, "shin": 0.006}


def wearing(garments: str, **others: str) -> dict[str, Color]:
    """Colors by name, from six hexadecimal digits each: those of the markers in their order, then others."""
    named = {**dict(zip(MARKERS, garments.split(), strict=True)), **others}
    return {name: (int(code[:2], 16), int(code[2:4], 16), int(code[4:], 16)) for name, code in named.items()}


@dataclass(frozen=True)
class Look:
    """A performer's appearance."""

    colors: Mapping[str, Color] = field(default_factory=dict)
    """Colors that differ from `CLOTHES`, by name."""
    girths: Mapping[str, float] = field(default_factory=dict)
    """Factors of the limbs' and the trunk's thickness other than 1, by kind of segment."""
    cloth_m: Mapping[str, float] = field(default_factory=lambda: CLOTH_M)
    """Distance of each garment from the skin, by kind of segment."""
    folds: float = 0.0
    """Relative variation of a garment's distance from the skin: its wrinkles."""

    @property
    def painted(self) -> dict[str, Color]:
        """Every color, by name, markers first."""
        return {**CLOTHES, **self.colors}
