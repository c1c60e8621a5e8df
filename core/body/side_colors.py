"""The one color code of left and right: bones, overlays, reports and the pages say the same by it.

Blue is the performer's left, orange the right; no kind of eye confuses them: Okabe and Ito (2008), *Color
Universal Design*. A side has one hue in two strengths, since a line must stand out from what is behind it.
All are red, green and blue in sRGB, 0 to 255.
"""

from collections.abc import Mapping

Rgb = tuple[int, int, int]

LIGHT: Mapping[str, Rgb] = {"L": (87, 181, 232), "R": (245, 168, 26), "": (235, 235, 235)}
"""By side, over footage and in Blender's dark viewport: sky blue and orange; the middle has no side."""
STRONG: Mapping[str, Rgb] = {"L": (0, 114, 178), "R": (213, 94, 0), "": (42, 45, 51)}
"""By side, on white paper: blue and vermilion, the dark neighbors of those; ink for the middle."""

SHADED: Mapping[str, Rgb] = {**STRONG, "": (150, 153, 158)}
"""The strong ones where the ground is dark: of bones that are not selected."""


def side_of(name: str) -> str:
    """The side in a name of Keymark's own: `L`, `R`, or nothing for the middle."""
    side = name.rpartition(".")[2]
    return side if side in ("L", "R") else ""
