"""The camera that is assumed before anybody has said what the footage was taken with."""

from dataclasses import dataclass
from math import hypot

import numpy as np

from ..arrays import Array

FULL_FRAME_MM = 36.0
"""Long side of the full-frame sensor that focal lengths are compared on [mm]."""
FULL_FRAME_DIAGONAL_MM = hypot(36.0, 24.0)

PHONE_MM = 26.0
"""Full-frame equivalent of a phone's main camera by its diagonal [mm]; makers state 24 to 28."""
STABILISED = 1.1
"""By how much phones narrow a video's view to steady it: a tenth is usual."""
WEBCAM_DEGREES = 68.0
"""Diagonal view of a webcam in 16 to 9: makers state 60 (plain ones) to 78 (better ones)."""
WEBCAM_HEIGHT_PX = 600
"""Up to this height a picture of 4 to 3 is taken for a webcam's; above, cameras film wider pictures."""
USUAL_MM = 35.0
"""Of any other camera: between the wide end of a camera's usual zoom (24 to 28) and its middle (50) [mm]."""

EYE_HEIGHT_M = 1.4
REACH_M = 1.0
"""How far an adult with arms outstretched reaches from the origin to either side [m]."""
FILLED = 0.9
"""Share of the picture that a performer at the origin may fill."""


@dataclass(frozen=True)
class LensGuess:
    """A lens that nobody stated."""

    lens_mm: float
    sensor_width_mm: float
    """Spans the picture's width; the sensor's long side is that of full frame [mm]."""
    reason: str
    """What it was guessed from, to stand after "as of"."""


def guess_lens(size: tuple[int, int]) -> LensGuess:
    """Guess a lens from the size of the picture.

    A picture higher than wide is a phone's; its focal length is stated for photographs of 4 to 3, whose long
    side a video keeps. A small one of 4 to 3 is a webcam's, which cuts the sides off its view of 16 to 9.

    Args:
        size: Width and height [px], as shown, so after any rotation that the file asks for.
    """
    width, height = size
    if height > width:
        photograph_mm = FULL_FRAME_DIAGONAL_MM * 4.0 / 5.0
        lens_mm, reason = STABILISED * PHONE_MM * FULL_FRAME_MM / photograph_mm, "a phone held upright"
    elif 3 * width == 4 * height and height <= WEBCAM_HEIGHT_PX:
        focal_in_heights = 0.5 * hypot(16.0, 9.0) / 9.0 / np.tan(np.radians(WEBCAM_DEGREES / 2.0))
        lens_mm, reason = float(focal_in_heights * height / width * FULL_FRAME_MM), "a webcam"
    else:
        lens_mm, reason = USUAL_MM, "a camera's usual zoom"
    return LensGuess(round(lens_mm, 1), FULL_FRAME_MM * width / max(width, height), reason)


def default_camera_pose(lens_mm: float, sensor_width_mm: float, size: tuple[int, int]) -> Array:
    """Where a camera is put at first: (4, 4) camera to world [m].

    It stands at eye height, looks level along +Y at the world's origin, and so far away that the floor there
    and a performer with arms outstretched are within the picture.

    Args:
        lens_mm: Focal length.
        sensor_width_mm: Width of the sensor, which spans the picture's width.
        size: Width and height of the picture [px].
    """
    across = 0.5 * FILLED * sensor_width_mm / lens_mm
    down = across * size[1] / size[0]
    distance = max(EYE_HEIGHT_M / down, REACH_M / across)
    return np.array(
        [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, -1.0, -distance],
            [0.0, 1.0, 0.0, EYE_HEIGHT_M],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
