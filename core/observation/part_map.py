"""Which part of the body each pixel shows: the whole body drawn part over part, the farthest first."""

import cv2
import numpy as np
from numpy.typing import NDArray

from .cover import Covers

Array = NDArray[np.float64]

NOWHERE = 255
"""While drawing, what is -1 as a signed byte."""
FINENESS = 4
"""Binary digits of a pixel's fraction that outlines are drawn to."""

_TURN = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
CIRCLE = np.stack([np.cos(_TURN), np.sin(_TURN)])


def part_map(parts: Covers, frame: int, size: tuple[int, int], factor: float) -> NDArray[np.int8]:
    """Draw the body of one frame.

    Args:
        parts: Outlines of the O parts in all frames.
        frame: The one of them to draw.
        size: Columns and rows of the map.
        factor: Pixels of the camera to one of the map.

    Returns:
        (rows, columns) index of the part seen, -1 where none is.
    """
    labels = np.full((size[1], size[0]), NOWHERE, dtype=np.uint8)
    for part in np.argsort(-parts.depth[frame].mean(-1)):
        ends = np.stack([parts.start[frame, part], parts.end[frame, part]])
        if not np.isfinite(ends).all():
            continue
        for polygon in _outline(ends, parts.half_width[frame, part], parts.overshoot[frame, part]):
            corners = np.round((polygon / factor - 0.5) * 2**FINENESS).astype(np.int32)
            cv2.fillConvexPoly(labels, corners, (int(part),), cv2.LINE_8, FINENESS)
    return labels.view(np.int8)


def _outline(ends: Array, half_width: Array, overshoot: Array) -> list[Array]:
    """The wall between two ends (2, 2) and both elliptical ends, as polygons [px]."""
    along = ends[1] - ends[0]
    along = along / max(float(np.hypot(*along)), 1e-6)
    across = np.array([-along[1], along[0]])
    sides = half_width[:, None] * across
    caps = [
        ends[i] + half_width[i] * np.outer(CIRCLE[0], across) + overshoot[i] * np.outer(CIRCLE[1], along)
        for i in range(2)
    ]
    return [np.stack([ends[0] + sides[0], ends[1] + sides[1], ends[1] - sides[1], ends[0] - sides[0]]), *caps]
