"""The reconstructed body as lines between its 13 points, and how certain each point is."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .figures import circles, dashes, segments
from .picture import Fill, Item, Stroke
from .style import CORE, DASH, GAP, JOINT, LIMB, SIDES, Style, side_color

if TYPE_CHECKING:
    from ....core.review import Review

Array = NDArray[np.float64]

ARM, LEG = ("shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")


def skeleton(
    review: "Review", index: int, places: Array, pixels_per_metre: Array, limit_m: float, style: Style
) -> list[Item]:
    """The body of one frame.

    Args:
        review: What there is to see.
        index: Place of the frame.
        places: (13, 2) the points in the region.
        pixels_per_metre: (13,) size of a metre at each point in the region.
        limit_m: A point whose standard deviation is larger is uncertain.
        style: How to draw.
    """
    items: list[Item] = []
    width = LIMB * style.width * style.body_scale
    for side, line in limbs(review.point_names, places):
        parts = segments(line)
        items.append(Stroke(parts, style.color(SIDES[side]), width, style.halo))
        if side == "R":
            items.append(Stroke(parts, style.color(CORE), 0.45 * width))
    sigma = review.sigma_m[index]
    uncertain = sigma > limit_m
    for point, name in enumerate(review.point_names):
        items += _joint(places[point], name, bool(uncertain[point]), style)
    for point in np.flatnonzero(uncertain):
        (reach,) = circles(places[point : point + 1], sigma[point] * pixels_per_metre[point], 48)
        rim = dashes(reach, DASH * style.scale, GAP * style.scale, closed=True)
        items.append(Stroke(rim, style.color(side_color(review.point_names[point])), 1.0, style.halo))
    return items


def limbs(names: Sequence[str], places: Array) -> list[tuple[str, Array]]:
    """Side and line (N, 2) of each part of the body, from its points (13, 2)."""
    at = dict(zip(names, places, strict=True))
    neck = 0.5 * (at["shoulder.L"] + at["shoulder.R"])
    pelvis = 0.5 * (at["hip.L"] + at["hip.R"])
    lines = [
        ("", np.stack([at["head"], neck, pelvis])),
        ("", np.stack([at["shoulder.L"], at["shoulder.R"]])),
        ("", np.stack([at["hip.L"], at["hip.R"]])),
    ]
    for side in ("L", "R"):
        for chain in (ARM, LEG):
            lines.append((side, np.stack([at[f"{joint}.{side}"] for joint in chain])))
    return lines


def _joint(place: Array, name: str, uncertain: bool, style: Style) -> list[Item]:
    """A disc, or a ring where the point is uncertain."""
    color = style.color(side_color(name))
    (rim,) = circles(place[None], style.size(JOINT), 16)
    edge = Stroke(segments(rim, closed=True), color, 1.5, style.halo)
    return [edge] if uncertain else [edge, Fill(rim[None], color)]
