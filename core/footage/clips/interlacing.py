"""Interlacing: detection of combed pictures, whose even and odd rows are two fields from two moments."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Image

STEP = 8
"""Difference of neighboring rows where a moving edge is combed, in levels."""
TEETH = 5
"""Alternating steps that make a comb; noise and textures seldom have as many."""
COLUMNS = 320
"""Fewest sampled columns."""


def combed_shares(image: Image) -> tuple[float, float]:
    """Combed shares of a picture: by rows, as interlacing makes them, and by columns for comparison.

    Args:
        image: (rows, columns, 3) as decoded: scaling removes combs.

    Returns:
        Two shares of the sampled pixels.
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
    windows = len(step) - TEETH + 1
    up, down = step > STEP, step < -STEP
    rising = np.logical_and.reduce([up[tooth : tooth + windows] for tooth in range(TEETH)])
    falling = np.logical_and.reduce([down[tooth : tooth + windows] for tooth in range(TEETH)])
    return float(np.mean(rising | falling))
