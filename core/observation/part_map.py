"""Part segmentation of the body: the visible part of each pixel, by the painter's algorithm."""

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .occlusion import PartOutlines

NO_PART = 255
"""-1 as a signed byte."""
SUBPIXEL_BITS = 4
"""Fractional bits of the coordinates that outlines are drawn with."""

_TURN = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
CIRCLE = np.stack([np.cos(_TURN), np.sin(_TURN)])


def part_map(parts: PartOutlines, frame: int, size: tuple[int, int], factor: float) -> NDArray[np.int8]:
    """Draw the body of one frame, the farthest part first.

    Args:
        parts: Outlines of the O parts in all frames.
        frame: Index of the frame to draw.
        size: Columns and rows of the map.
        factor: Pixels of the camera to one of the map.

    Returns:
        (rows, columns) index of the visible part, -1 for none.
    """
    labels = np.full((size[1], size[0]), NO_PART, dtype=np.uint8)
    outlines = _outlines(parts, frame) / factor - 0.5
    whole = np.isfinite(outlines).all(axis=(1, 2))
    corners = np.round(np.where(whole[:, None, None], outlines, 0.0) * 2**SUBPIXEL_BITS).astype(np.int32)
    for part in np.argsort(-parts.depth[frame].mean(-1)):
        if whole[part]:
            hull = cv2.convexHull(corners[part])
            cv2.fillConvexPoly(labels, hull, (int(part),), cv2.LINE_8, SUBPIXEL_BITS)
    return labels.view(np.int8)


def _outlines(parts: PartOutlines, frame: int) -> Array:
    """(O, corners, 2) corners of the elliptical ends of all parts; a part's outline is their hull [px]."""
    ends = np.stack([parts.start[frame], parts.end[frame]], axis=1)  # (O, 2, 2)
    along = ends[:, 1] - ends[:, 0]
    along = along / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-6)
    across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    out = (parts.half_width[frame][..., None, None] * CIRCLE[0, :, None]) * across[:, None, None]
    past = (parts.overshoot[frame][..., None, None] * CIRCLE[1, :, None]) * along[:, None, None]
    return np.asarray((ends[:, :, None] + out + past).reshape(len(ends), -1, 2))
