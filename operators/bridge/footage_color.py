"""Color of a footage pixel, read from the file itself."""

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import InputError
from ...core.footage.clips.clip import FrameReader
from .footage import Footage

REACH_PX = 2
"""Pixels on each side of the picked one: the median of 5 x 5 is free of noise and chroma subsampling."""


def footage_color(footage: Footage, pixel: ArrayLike, scene_frame: int | None = None) -> tuple[int, int, int]:
    """Red, green, blue (0 to 255) at a pixel (2,) of the footage, by default in the scene's current frame.

    Raises:
        InputError: There is no footage, no frame of it at the scene's, or the pixel lies outside.
    """
    width, height = footage.clip.size
    x, y = np.floor(np.asarray(pixel, dtype=np.float64)).astype(int)
    if not (0 <= x < width and 0 <= y < height):
        raise InputError(f"pixel ({x}, {y}) lies outside the footage, which is {width} x {height} pixels")
    at = footage.scene.frame_current if scene_frame is None else scene_frame
    image = FrameReader(footage.open()).image_at((at - footage.first_frame) / footage.rate)
    if image is None:
        raise InputError(f"the footage has no frame at scene frame {at}; go to one it has")
    around = image[max(0, y - REACH_PX) : y + REACH_PX + 1, max(0, x - REACH_PX) : x + REACH_PX + 1]
    blue, green, red = (round(float(value)) for value in np.median(around.reshape(-1, 3), axis=0))
    return red, green, blue
