"""Pictures in which nothing is to be seen: black or white ones, and what stands for frames that are lost."""

import numpy as np

from ...arrays import Image

LOOKED_AT = 64
"""Rows and columns that tell enough, about."""
CONTRAST = 12
"""Levels between the darkest and the brightest of nothing, but for noise."""
STRAY = 0.005
"""Share of pixels that noise or a clock in a corner may make brighter or darker."""


def is_blank(image: Image) -> bool:
    """Tell whether a picture (rows, columns, 3) shows one even color and nothing else."""
    step = max(min(image.shape[:2]) // LOOKED_AT, 1)
    looked_at = image[step // 2 :: step, step // 2 :: step]
    # Channel by channel: the first tells of almost every picture, and partitions along an axis are slow.
    return not any(_has_contrast(looked_at[..., channel].ravel()) for channel in range(3))


def _has_contrast(levels: Image) -> bool:
    stray = int(STRAY * len(levels))
    ordered = np.partition(levels, (stray, len(levels) - 1 - stray))
    return bool(int(ordered[len(levels) - 1 - stray]) - int(ordered[stray]) > CONTRAST)
