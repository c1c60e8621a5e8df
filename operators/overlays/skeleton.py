"""The reconstructed body as lines between its 13 points, with each point's uncertainty."""

from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Array, BoolArray
from .figures import circles, segments
from .picture import Fill, Item, Stroke
from .style import CORE, CORE_SHARE, JOINT, LIMB, SIDES, UNCERTAIN_M, Style, side_color

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
    review: "Review", index: int, positions: Array, pixels_per_meter: Array, style: Style
) -> list[Item]:
    """The body of one frame.

    Args:
        review: The review of the motion.
        index: Index of the frame.
        positions: (13, 2) region pixels of the points.
        pixels_per_meter: (13,) size of a meter at each point in the region.
        style: Colors and sizes.
    """
    sigma = review.sigma_m[index]
    uncertain = sigma > UNCERTAIN_M
    colors = np.array([style.color(side_color(name)) for name in review.point_names])
    return [
        *_limbs(review.point_names, positions, style),
        *_joints(positions, uncertain, colors, style),
        _deviations(positions[uncertain], (sigma * pixels_per_meter)[uncertain], colors[uncertain], style),
    ]


def limb_lines(names: tuple[str, ...], positions: Array) -> tuple[Array, BoolArray]:
    """Lines (N, 2, 2) of a body from its points (13, 2), and which of them (N,) are of the right side.

    A line with an end that is not finite is left out.
    """
    lines, sides = _lines(names, positions)
    seen = np.isfinite(lines).all(axis=(-2, -1))
    return lines[seen], np.array([side == "R" for side in sides])[seen]


def _lines(names: tuple[str, ...], positions: Array) -> tuple[Array, list[str]]:
    at = dict(zip(names, positions, strict=True))
    at[NECK] = 0.5 * (at["shoulder.L"] + at["shoulder.R"])
    at[PELVIS] = 0.5 * (at["hip.L"] + at["hip.R"])
    return np.array([[at[start], at[end]] for _, start, end in LIMBS]), [side for side, _, _ in LIMBS]


def _limbs(names: tuple[str, ...], positions: Array, style: Style) -> list[Item]:
    """Lines in the colors of their sides; those of the right have a dark core."""
    lines, sides = _lines(names, positions)
    colors = np.array([style.color(SIDES[side]) for side in sides])
    seen = np.isfinite(lines).all(axis=(-2, -1))
    hollow = seen & np.array([side == "R" for side in sides])
    width = LIMB * style.width * style.body_scale
    return [
        Stroke(lines[seen], colors[seen], width, style.halo),
        Stroke(lines[hollow], style.color(CORE), CORE_SHARE * width),
    ]


def _joints(positions: Array, uncertain: BoolArray, colors: Array, style: Style) -> list[Item]:
    """Discs, and rings for uncertain points."""
    rims = circles(positions, style.size(JOINT), 16)
    seen = np.isfinite(positions).all(axis=-1)
    edges = Stroke(segments(rims[seen], closed=True), np.repeat(colors[seen], 16, axis=0), 1.5, style.halo)
    return [edges, Fill(rims[seen & ~uncertain], colors[seen & ~uncertain])]


def _deviations(positions: Array, radii: Array, colors: Array, style: Style) -> Stroke:
    """Dashed circles as large as the points' standard deviations."""
    seen = np.isfinite(positions).all(axis=-1) & np.isfinite(radii)
    parts = segments(circles(positions[seen], radii[seen], 48), closed=True)[::2]
    return Stroke(parts, np.repeat(colors[seen], 24, axis=0), 1.0, style.halo)
