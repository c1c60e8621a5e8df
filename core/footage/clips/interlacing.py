"""Interlaced video: two moments in one picture, one in the even rows and one in the odd ones."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Image

STEP = 8
"""Levels by which neighboring rows differ where a moving edge is combed."""
TEETH = 5
"""Steps up and down in turn that neither noise nor a texture makes so often."""
COLUMNS = 320
"""Fewest that are looked at."""


def combed_shares(image: Image) -> tuple[float, float]:
    """Return how much of a picture looks combed, by rows as fields do it, and by columns for comparison.

    Args:
        image: (rows, columns, 3) as it was decoded: scaled pictures have lost their teeth.

    Returns:
        Two shares of the picture's places.
    """
    green = image[..., 1].astype(np.int16)
    across = max(image.shape[1] // COLUMNS, 1)
    down = max(image.shape[0] // COLUMNS, 1)
    return _teeth(green[:, ::across]), _teeth(green[::down].T)


def _teeth(levels: NDArray[np.int16]) -> float:
    step = np.diff(levels, axis=0)
    if len(step) < TEETH:
        return 0.0
    step[1::2] *= -1
    places = len(step) - TEETH + 1
    up, down = step > STEP, step < -STEP
    rising = np.logical_and.reduce([up[tooth : tooth + places] for tooth in range(TEETH)])
    falling = np.logical_and.reduce([down[tooth : tooth + places] for tooth in range(TEETH)])
    return float(np.mean(rising | falling))
