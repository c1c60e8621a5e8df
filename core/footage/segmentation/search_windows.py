"""Where in a picture the markers may be: windows about whatever has their colors on a coarse grid."""

from collections.abc import Sequence

import cv2
import numpy as np

from ...arrays import Image

Box = tuple[int, int, int, int]

MOST_BOXES = 12
"""Boxes kept of each color in a frame, those with most of it."""
MARGIN = 6
"""Pixels about a box when it is measured: border band, and background enough to know its color."""


def colored_boxes(label: Image, color: int, factor: int) -> list[Box]:
    """Return boxes (left, top, right, bottom) about all of a color in pixels of the measuring grid.

    Args:
        label: (rows, columns) color of each pixel of the coarse grid.
        color: which one.
        factor: pixels of the measuring grid that one of the coarse grid spans.
    """
    mask = np.equal(label, color).view(np.uint8)
    x, y, columns, rows = cv2.boundingRect(mask)
    if not columns:
        return []
    part = np.ascontiguousarray(mask[y : y + rows, x : x + columns])
    _, _, stats, _ = cv2.connectedComponentsWithStats(part, connectivity=8, ltype=cv2.CV_16U)
    stats = stats[1:]
    if len(stats) > MOST_BOXES:
        stats = stats[np.argsort(-stats[:, cv2.CC_STAT_AREA], kind="stable")[:MOST_BOXES]]
    return [
        ((x + a) * factor, (y + b) * factor, (x + a + c) * factor, (y + b + d) * factor)
        for a, b, c, d, _ in stats.tolist()
    ]


def boxes_to_measure(seen: Sequence[Box], followed: Sequence[Box]) -> list[Box]:
    """Return boxes about what is to be measured; what would overlap with its margin shares one.

    So no pixel is measured twice for a color.

    Args:
        seen: where the color is seen.
        followed: where it was just before; of use where the coarse grid slips through what is left of it.
    """
    pending = list(seen) + [box for box in followed if not any(_overlap(box, other, 0) for other in seen)]
    boxes = []
    while pending:
        a, b, c, d = pending.pop()
        for other in pending:
            if _overlap((a, b, c, d), other, 2 * MARGIN):
                pending.remove(other)
                pending.append((min(a, other[0]), min(b, other[1]), max(c, other[2]), max(d, other[3])))
                break
        else:
            boxes.append((a, b, c, d))
    return boxes


def _overlap(first: Box, second: Box, gap: int) -> bool:
    """Tell whether two boxes lie less than a gap apart."""
    across = first[0] - gap < second[2] and second[0] < first[2] + gap
    return across and first[1] - gap < second[3] and second[1] < first[3] + gap
