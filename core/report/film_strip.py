"""A strip of small pictures of the footage with the estimate over it, by which a list shows a take.

Each picture is a square around the performer, so that a small figure in a wide shot is still seen.
"""

from collections.abc import Mapping

import cv2
import numpy as np

from ..arrays import Array, Image
from ..take.motion import Motion
from ..take.take import Take
from .canvas import Canvas
from .overlay_sheet import paler
from .stick_figure import draw_figure, stick_figure

PICTURES = 6
SIDE = 160
"""Side of one picture [px]; a list shows it at about half of that, sharp on screens of double density."""
GAP = 4
SIZE = (PICTURES * SIDE + (PICTURES - 1) * GAP, SIDE)
"""Width and height of every strip, so that a page knows them before it is loaded."""
LIMB_WIDTH = 2.2
PAPER = (226, 222, 219)
"""Color where the clip has fewer frames, or the square is larger than the picture."""
PADDING = 1.35
"""Side of the square in heights or widths of the largest figure, whose points end at the head's center."""
SMALLEST_SIDE = 0.3
"""Smallest side of the square, of the picture's shorter side: limits the magnification of a tiny figure."""


def film_strip(take: Take, motion: Motion, images: Mapping[int, Image]) -> Image:
    """Draw frames of the clip side by side, each cut to a square around the performer.

    Args:
        take: The take.
        motion: Its motion.
        images: At most `PICTURES` frames of the clip by frame index, in the order to show them; reduced or
            whole.

    Returns:
        (SIZE[1], SIZE[0], 3) picture.
    """
    strip = Canvas(*SIZE, PAPER)
    figure = stick_figure(motion)
    centers, side = _squares(take, motion, list(images))
    for index, ((frame, image), center) in enumerate(zip(images.items(), centers, strict=True)):
        corner, scale = center - 0.5 * side, SIDE / side
        tile = Canvas(SIDE, SIDE)
        tile.paste(_cut(image, corner, side, take.camera.resolution), 0, 0, SIDE, SIDE)

        def project(
            points: Array, frame: int = frame, corner: Array = corner, scale: float = scale
        ) -> tuple[Array, Array]:
            pixels, depth = take.camera.project(points, frame)
            return scale * (pixels - corner), depth

        draw_figure(tile, figure, frame, project, LIMB_WIDTH, outlined=True)
        strip.paste(tile.image(), index * (SIDE + GAP), 0, SIDE, SIDE)
    return strip.image()


def _squares(take: Take, motion: Motion, frames: list[int]) -> tuple[Array, float]:
    """Centers (K, 2) and common side of squares around the figure in each frame [px].

    They stay inside the picture where they fit.
    """
    size = np.array(take.camera.resolution, dtype=np.float64)
    centers, extents = np.tile(0.5 * size, (len(frames), 1)), np.zeros(len(frames))
    for index, frame in enumerate(frames):
        pixels, _ = take.camera.project(motion.points[frame], frame)
        seen = pixels[np.isfinite(pixels).all(axis=-1)]
        if len(seen):
            low, high = np.clip(seen.min(axis=0), 0.0, size), np.clip(seen.max(axis=0), 0.0, size)
            centers[index], extents[index] = 0.5 * (low + high), (high - low).max()
    wanted = PADDING * extents.max() if extents.any() else size.max()
    side = float(np.clip(wanted, SMALLEST_SIDE * size.min(), size.max()))
    half = np.minimum(0.5 * side, 0.5 * size)
    return np.clip(centers, half, size - half), side


def _cut(image: Image, corner: Array, side: float, resolution: tuple[int, int]) -> Image:
    """The square of a frame, paler, padded where it reaches beyond the picture."""
    shrunk = image.shape[1] / resolution[0]
    across = max(round(shrunk * side), 1)
    left, top = (int(value) for value in np.round(shrunk * corner))
    rows = slice(max(top, 0), min(top + across, image.shape[0]))
    columns = slice(max(left, 0), min(left + across, image.shape[1]))
    inside = paler(image[rows, columns])
    above, before = rows.start - top, columns.start - left
    below, behind = across - above - inside.shape[0], across - before - inside.shape[1]
    filled = cv2.copyMakeBorder(inside, above, below, before, behind, cv2.BORDER_CONSTANT, value=PAPER)
    return np.asarray(filled, dtype=np.uint8)
