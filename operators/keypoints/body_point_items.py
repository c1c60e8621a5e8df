"""Menu of the points of the body, in columns."""

from ...core.body.human import HUMAN
from ...core.footage.keypoints.body_points import FACE, FEET, HANDS, SPINE
from ..markers.properties import segment_title

Item = tuple[str, str, str]

COLUMNS = (
    ("Joints", HUMAN.point_names),
    ("Head and Trunk", (*FACE, *SPINE)),
    ("Hands and Feet", (*HANDS, *FEET)),
)
"""Heading and points of each column."""
NO_POINT = "NONE"


def body_point_items(without: str = "") -> list[Item]:
    """Items of a menu of the body points.

    Args:
        without: Label of an entry for none; empty for a menu without it.
    """
    items: list[Item] = [(NO_POINT, without, "")] if without else []
    for heading, points in COLUMNS:
        items.append(("", heading, ""))
        items += [(point, segment_title(point), "") for point in points]
    return items


def point_title(point: str) -> str:
    """Label of a body point."""
    return segment_title(point)
