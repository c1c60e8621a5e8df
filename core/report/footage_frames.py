"""Frames of the footage for pictures, no larger than a picture needs them."""

from collections.abc import Sequence

import cv2
import numpy as np

from ..arrays import Image
from ..footage.clips.clip import Clip
from .canvas import SCALE
from .overlay_sheet import CELL_WIDTH


def footage_frames(clip: Clip, frames: Sequence[int]) -> dict[int, Image]:
    """Frames of a clip by their index, rising; those that cannot be read are left out.

    Raises:
        InputError: The clip can no longer be read.
    """
    return {frame: _reduced(image) for frame, image in clip.source.at(list(frames))}


def _reduced(image: Image) -> Image:
    """The frame, reduced to the width of a cell: dozens of full 8K frames would fill the memory."""
    height, width = image.shape[:2]
    most = CELL_WIDTH * SCALE
    if width <= most:
        return image
    size = (most, max(1, round(most * height / width)))
    return np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
