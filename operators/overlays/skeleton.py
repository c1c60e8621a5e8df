"""The reconstructed body as lines between its 13 points, and how certain each point is."""

from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Array, BoolArray
from .figures import circles, segments
from .picture import Fill, Item, Stroke
from .style import CORE, CORE_SHARE, JOINT, LIMB, SIDES, Style, side_color

if TYPE_CHECKING:
    from ...core.review.review import Review


NECK, PELVIS = "neck", "pelvis"
"""The middle between the shoulders, and between the hips."""
LIMBS = (
    ("", "head", NECK),
    ("", NECK, PELVIS),
    ("", "shoulder.L", "shoulder.R"),
    ("", "hip.L", "hip.R"),
    *(
        (side, f"{start}.{side}", f"{end}.{side}")
        for side in ("L", "R")
        for start, end in (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))
    ),
)
"""Side and ends of each line."""


def skeleton(
    review: "Review", index: int, places: Array, pixels_per_meter: Array, limit_m: float, style: Style
) -> list[Item]:
    """The body of one frame.

    Args:
        review: What there is to see.
        index: Place of the frame.
        places: (13, 2) the points in the region.
        pixels_per_meter: (13,) size of a meter at each point in the region.
        limit_m: A point whose standard deviation is larger is uncertain.
        style: How to draw.
    """
    sigma = review.sigma_m[index]
    uncertain = sigma > limit_m
    colors = np.array([style.color(side_color(name)) for name in review.point_names])
    return [
        *_limbs(review.point_names, places, style),
        *_joints(places, uncertain, colors, style),
        _doubt(places[uncertain], (sigma * pixels_per_meter)[uncertain], colors[uncertain], style),
    ]


def _limbs(names: tuple[str, ...], places: Array, style: Style) -> list[Item]:
    """Lines with sides' colors; those on the right have a dark core."""
    at = dict(zip(names, places, strict=True))
    at[NECK] = 0.5 * (at["shoulder.L"] + at["shoulder.R"])
    at[PELVIS] = 0.5 * (at["hip.L"] + at["hip.R"])
    lines = np.array([[at[start], at[end]] for _, start, end in LIMBS])
    colors = np.array([style.color(SIDES[side]) for side, _, _ in LIMBS])
    seen = np.isfinite(lines).all(axis=(-2, -1))
    hollow = seen & np.array([side == "R" for side, _, _ in LIMBS])
    width = LIMB * style.width * style.body_scale
    return [
        Stroke(lines[seen], colors[seen], width, style.halo),
        Stroke(lines[hollow], style.color(CORE), CORE_SHARE * width),
    ]


def _joints(places: Array, uncertain: BoolArray, colors: Array, style: Style) -> list[Item]:
    """Discs, and rings where a point is uncertain."""
    rims = circles(places, style.size(JOINT), 16)
    seen = np.isfinite(places).all(axis=-1)
    edges = Stroke(segments(rims[seen], closed=True), np.repeat(colors[seen], 16, axis=0), 1.5, style.halo)
    return [edges, Fill(rims[seen & ~uncertain], colors[seen & ~uncertain])]


def _doubt(places: Array, radii: Array, colors: Array, style: Style) -> Stroke:
    """Dashed circles as large as the points' standard deviations."""
    seen = np.isfinite(places).all(axis=-1) & np.isfinite(radii)
    parts = segments(circles(places[seen], radii[seen], 48), closed=True)[::2]
    return Stroke(parts, np.repeat(colors[seen], 24, axis=0), 1.0, style.halo)
