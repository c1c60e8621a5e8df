"""Search windows: boxes around the pixels of the markers' colors on a coarse grid."""

from collections.abc import Sequence

import cv2
import numpy as np

from ...arrays import Image

Box = tuple[int, int, int, int]

MOST_BOXES = 12
"""Most boxes kept of each color in a frame, those with most pixels of it."""
MARGIN = 6
"""Margin in px around a measured box: the border band, and enough background to know its color."""


def colored_boxes(label: Image, color: int, factor: int) -> list[Box]:
    """Boxes (left, top, right, bottom) around the components of a color, in pixels of the measuring grid.

    Args:
        label: (rows, columns) color of each pixel of the coarse grid.
        color: Index of the color.
        factor: Pixels of the measuring grid to one of the coarse grid.
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
    """Boxes to measure; those that overlap with their margins are merged.

    So no pixel is measured twice for a color.

    Args:
        seen: Boxes of the color on the coarse grid.
        followed: Boxes in the frame before, for regions too small for the coarse grid.
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
    """Whether two boxes lie less than a gap apart."""
    across = first[0] - gap < second[2] and second[0] < first[2] + gap
    return across and first[1] - gap < second[3] and second[1] < first[3] + gap
