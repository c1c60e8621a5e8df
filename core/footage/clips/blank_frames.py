"""Pictures in which nothing is to be seen: black or white ones, and what stands for frames that are lost."""

from __future__ import annotations

from typing import Final

import numpy as np

from ...arrays import Image

_LOOKED_AT: Final = 64
"""Rows and columns that tell enough, about."""
_CONTRAST: Final = 12
"""Levels between the darkest and the brightest of nothing, but for noise."""
_STRAY: Final = 0.005
"""Share of pixels that noise or a clock in a corner may make brighter or darker."""


def is_blank(image: Image) -> bool:
    """Tell whether a picture (rows, columns, 3) shows one even color and nothing else."""
    step = max(min(image.shape[:2]) // _LOOKED_AT, 1)
    looked_at = image[step // 2 :: step, step // 2 :: step]
    # Channel by channel: the first tells of almost every picture, and partitions along an axis are slow.
    return not any(_has_contrast(looked_at[..., channel].ravel()) for channel in range(3))


def _has_contrast(levels: Image) -> bool:
    stray = int(_STRAY * len(levels))
    ordered = np.partition(levels, (stray, len(levels) - 1 - stray))
    return bool(int(ordered[len(levels) - 1 - stray]) - int(ordered[stray]) > _CONTRAST)
