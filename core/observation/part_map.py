"""Which part of the body each pixel shows: the whole body drawn part over part, the farthest first."""

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .occlusion import PartOutlines

NOWHERE = 255
"""While drawing, what is -1 as a signed byte."""
FINENESS = 4
"""Binary digits of a pixel's fraction that outlines are drawn to."""

_TURN = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
CIRCLE = np.stack([np.cos(_TURN), np.sin(_TURN)])


def part_map(parts: PartOutlines, frame: int, size: tuple[int, int], factor: float) -> NDArray[np.int8]:
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
    outlines = _outlines(parts, frame) / factor - 0.5
    whole = np.isfinite(outlines).all(axis=(1, 2))
    corners = np.round(np.where(whole[:, None, None], outlines, 0.0) * 2**FINENESS).astype(np.int32)
    for part in np.argsort(-parts.depth[frame].mean(-1)):
        if whole[part]:
            hull = cv2.convexHull(corners[part])
            cv2.fillConvexPoly(labels, hull, (int(part),), cv2.LINE_8, FINENESS)
    return labels.view(np.int8)


def _outlines(parts: PartOutlines, frame: int) -> Array:
    """(O, corners, 2) the elliptical ends of all parts; a part's outline is their hull [px]."""
    ends = np.stack([parts.start[frame], parts.end[frame]], axis=1)  # (O, 2, 2)
    along = ends[:, 1] - ends[:, 0]
    along = along / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-6)
    across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    out = (parts.half_width[frame][..., None, None] * CIRCLE[0, :, None]) * across[:, None, None]
    past = (parts.overshoot[frame][..., None, None] * CIRCLE[1, :, None]) * along[:, None, None]
    return np.asarray((ends[:, :, None] + out + past).reshape(len(ends), -1, 2))
