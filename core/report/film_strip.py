"""A strip of small pictures of the footage with the estimate over it: one look a take, in a list of hundreds.

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
"""Of one picture [px]; a list shows it at about half of that, sharp on screens of twice the points."""
GAP = 4
SIZE = (PICTURES * SIDE + (PICTURES - 1) * GAP, SIDE)
"""Width and height of every strip, so that a page knows them before it is loaded."""
LIMB_WIDTH = 2.2
PAPER = (226, 222, 219)
"""Where the clip has fewer frames, or the square is larger than the picture."""
ROOM = 1.35
"""Side of the square in heights or widths of the largest figure: the points end at the head's center."""
SMALLEST_SHARE = 0.3
"""Of the picture's shorter side: a posture that is squeezed to a dot is not magnified without end."""


def film_strip(take: Take, motion: Motion, images: Mapping[int, Image]) -> Image:
    """Draw frames of the clip side by side, each cut to a square around the performer.

    Args:
        take: The take.
        motion: Its motion.
        images: At most `PICTURES` frames of the clip by position, in the order to show them; they may be
            smaller than the clip's.

    Returns:
        (SIZE[1], SIZE[0], 3) picture.
    """
    strip = Canvas(*SIZE, PAPER)
    figure = stick_figure(motion)
    centers, side = _squares(take, motion, list(images))
    for place, ((frame, image), center) in enumerate(zip(images.items(), centers, strict=True)):
        corner, scale = center - 0.5 * side, SIDE / side
        tile = Canvas(SIDE, SIDE)
        tile.paste(_cut(image, corner, side, take.camera.resolution), 0, 0, SIDE, SIDE)

        def project(
            points: Array, frame: int = frame, corner: Array = corner, scale: float = scale
        ) -> tuple[Array, Array]:
            pixels, depth = take.camera.project(points, frame)
            return scale * (pixels - corner), depth

        draw_figure(tile, figure, frame, project, LIMB_WIDTH, outlined=True)
        strip.paste(tile.image(), place * (SIDE + GAP), 0, SIDE, SIDE)
    return strip.image()


def _squares(take: Take, motion: Motion, frames: list[int]) -> tuple[Array, float]:
    """Centers (K, 2) and the one side of squares that hold the figure in every frame [px].

    They stay inside the picture where they fit.
    """
    size = np.array(take.camera.resolution, dtype=np.float64)
    centers, extents = np.tile(0.5 * size, (len(frames), 1)), np.zeros(len(frames))
    for place, frame in enumerate(frames):
        pixels, _ = take.camera.project(motion.points[frame], frame)
        seen = pixels[np.isfinite(pixels).all(axis=-1)]
        if len(seen):
            low, high = np.clip(seen.min(axis=0), 0.0, size), np.clip(seen.max(axis=0), 0.0, size)
            centers[place], extents[place] = 0.5 * (low + high), (high - low).max()
    wanted = ROOM * extents.max() if extents.any() else size.max()
    side = float(np.clip(wanted, SMALLEST_SHARE * size.min(), size.max()))
    half = np.minimum(0.5 * side, 0.5 * size)
    return np.clip(centers, half, size - half), side


def _cut(image: Image, corner: Array, side: float, resolution: tuple[int, int]) -> Image:
    """The square of a frame, paler, filled up where it reaches beyond the picture."""
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
