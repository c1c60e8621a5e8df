"""Squares cut from frames around a figure, so that a small one in a wide shot is still seen."""

from collections.abc import Mapping, Sequence

import cv2
import numpy as np

from ..arrays import Array, Image
from ..footage.camera import Camera

PAPER = (226, 222, 219)
"""Color where the square is larger than the picture, or there is none."""
PADDING = 1.35
"""Side of the square in heights or widths of the largest figure, whose points end at the head's center."""
SMALLEST_SIDE = 0.3
"""Smallest side of the square, of the picture's shorter side: limits the magnification of a tiny figure."""


def squares_around(
    points: Array | Mapping[int, Array], camera: Camera, frames: Sequence[int]
) -> tuple[Array, float]:
    """Centers (K, 2) and common side of squares around the figure in each frame [px].

    They stay inside the picture where they fit.

    Args:
        points: (N, 3) places of the figure by frame index [m].
        camera: The camera.
        frames: Frame indices of the K pictures.
    """
    size = np.array(camera.resolution, dtype=np.float64)
    centers, extents = np.tile(0.5 * size, (len(frames), 1)), np.zeros(len(frames))
    for index, frame in enumerate(frames):
        pixels, _ = camera.project(points[frame], frame)
        seen = pixels[np.isfinite(pixels).all(axis=-1)]
        if len(seen):
            low, high = np.clip(seen.min(axis=0), 0.0, size), np.clip(seen.max(axis=0), 0.0, size)
            centers[index], extents[index] = 0.5 * (low + high), (high - low).max()
    wanted = PADDING * extents.max() if extents.any() else size.max()
    side = float(np.clip(wanted, SMALLEST_SIDE * size.min(), size.max()))
    half = np.minimum(0.5 * side, 0.5 * size)
    return np.clip(centers, half, size - half), side


def square_of(image: Image, corner: Array, side: float, resolution: tuple[int, int]) -> Image:
    """The square of a frame that may be reduced, padded where it reaches beyond the picture."""
    shrunk = image.shape[1] / resolution[0]
    across = max(round(shrunk * side), 1)
    left, top = (int(value) for value in np.round(shrunk * corner))
    rows = slice(max(top, 0), min(top + across, image.shape[0]))
    columns = slice(max(left, 0), min(left + across, image.shape[1]))
    inside = image[rows, columns]
    above, before = rows.start - top, columns.start - left
    below, behind = across - above - inside.shape[0], across - before - inside.shape[1]
    filled = cv2.copyMakeBorder(inside, above, below, before, behind, cv2.BORDER_CONSTANT, value=PAPER)
    return np.asarray(filled, dtype=np.uint8)
