"""The colors of a clip nearest to a sample, as suggestions where the sample matches nothing."""

import numpy as np
from numpy.typing import ArrayLike

from .color_space import cell_colors, chromaticity

HOW_MANY = 3
APART = 0.08
"""Least difference in chromaticity of two suggested colors."""
LIKE_LOG_LUMA = 0.25
"""Difference in the logarithm of luma up to which two grays look alike."""
SHARE = 2e-5
"""Least share of the clip's pixels of a color that is no noise."""


def nearest_colors(counts: ArrayLike, sample_srgb: tuple[int, int, int]) -> list[tuple[int, int, int]]:
    """Up to three colors (red, green, blue) found in the clip, the nearest to the sample first.

    Args:
        counts: (CELL_COUNT,) pixels of each color cell.
        sample_srgb: The sought color in 0..255.
    """
    count = np.asarray(counts, dtype=np.float64)
    common = np.flatnonzero(count > max(SHARE * count.sum(), 0.5))
    colors = cell_colors()[common]
    wanted, wanted_luma = chromaticity(np.asarray(sample_srgb, dtype=np.float64)[::-1])
    chroma, luma = chromaticity(colors)
    distance = np.linalg.norm(chroma - wanted, axis=1) + 0.1 * np.abs(np.log(luma / wanted_luma))
    chosen: list[int] = []
    for index in np.argsort(distance):
        if all(np.linalg.norm(chroma[index] - chroma[other]) >= APART for other in chosen):
            chosen.append(int(index))
        if len(chosen) == HOW_MANY:
            break
    return [(int(red), int(green), int(blue)) for blue, green, red in np.round(colors[chosen])]


def share_of_color(counts: ArrayLike, sample_srgb: tuple[int, int, int]) -> float:
    """The share of the clip's pixels that look like a color.

    Args:
        counts: (CELL_COUNT,) pixels of each color cell.
        sample_srgb: The color, (red, green, blue) in 0..255.
    """
    count = np.asarray(counts, dtype=np.float64)
    present = np.flatnonzero(count)
    wanted, wanted_luma = chromaticity(np.asarray(sample_srgb, dtype=np.float64)[::-1])
    chroma, luma = chromaticity(cell_colors(present.astype(np.int32)))
    like = (np.linalg.norm(chroma - wanted, axis=1) < APART / 2.0) & (
        np.abs(np.log(luma / wanted_luma)) < LIKE_LOG_LUMA
    )
    return float(count[present[like]].sum() / max(count.sum(), 1.0))
