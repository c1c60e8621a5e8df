"""How a performer looks: colors worn, girths, and how the clothes hang."""

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
}
"""Colors as painted (sRGB); light and camera change them."""
MARKERS = tuple(CLOTHES)[:5]
CLOTH_M = {"trunk": 0.005, "forearm": 0.003, "shin": 0.006}


@dataclass(frozen=True)
class Look:
    """A performer's appearance."""

    colors: Mapping[str, Color] = field(default_factory=dict)
    """Those that differ from `CLOTHES`, by name."""
    girths: Mapping[str, float] = field(default_factory=dict)
    """Factors of the limbs' and the trunk's thickness, by kind of segment, where they are not 1."""
    cloth_m: Mapping[str, float] = field(default_factory=lambda: CLOTH_M)
    """How far each garment stands off, by kind of segment."""
    folds: float = 0.0
    """Share by which a garment's distance from the body varies: its wrinkles."""

    @property
    def painted(self) -> dict[str, Color]:
        """Every color, by name, markers first."""
        return {**CLOTHES, **self.colors}
