"""The default camera of new footage: a lens guessed from the picture's size, and an initial pose."""

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
"""Crop factor of phones' video stabilization: a tenth is usual."""
WEBCAM_DEGREES = 68.0
"""Diagonal view of a webcam in 16 to 9: makers state 60 (plain ones) to 78 (better ones)."""
WEBCAM_HEIGHT_PX = 600
"""Largest height of a 4 to 3 picture that counts as a webcam's; other cameras film larger, wider pictures."""
USUAL_MM = 35.0
"""Lens of any other camera: between the wide end of a usual zoom (24 to 28) and its middle (50) [mm]."""

EYE_HEIGHT_M = 1.4
REACH_M = 1.0
"""Half the arm span of an adult [m]."""
FILLED = 0.9
"""Largest share of the picture that a performer at the origin fills."""


@dataclass(frozen=True)
class LensGuess:
    """A guessed lens."""

    lens_mm: float
    sensor_width_mm: float
    """Width of the sensor, which spans the picture's width; its long side is that of full frame [mm]."""
    reason: str
    """Kind of camera that was assumed, to follow "as of"."""


def guess_lens(size: tuple[int, int]) -> LensGuess:
    """Guess a lens from the size of the picture.

    An upright picture is a phone's; its focal length is stated for photographs of 4 to 3, whose long side a
    video keeps. A small one of 4 to 3 is a webcam's, which crops the sides of its 16 to 9 view.

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
    """Initial pose of a camera: (4, 4) camera to world [m].

    At eye height, looking level along +Y at the world's origin, from a distance at which the floor there and
    a performer with outstretched arms are within the picture.

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
