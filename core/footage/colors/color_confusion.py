"""Confusion matrix of the learned colors: how well markers are told from one another and the background."""

import numpy as np

from ...arrays import Array
from .color_model import ColorModel
from .color_space import cell_chromaticity, cell_volume

LEAST = 1e-300
"""A density that vanishes everywhere stays zero."""


def color_confusion(model: ColorModel) -> Array:
    """Confusion matrix (C, C + 1): shares of each color's pixels classified as each color, and as background.

    Pixels drawn from a color's learned density count by the posterior probability of their cells, as in
    tracking; rows sum to 1.

    Args:
        model: C colors learned for a clip.
    """
    cells = np.arange(len(model.label), dtype=np.int32)
    chroma, luma = cell_chromaticity(cells)
    count = len(model.distributions)
    claims = np.zeros((count, count + 1))
    for color, distribution in enumerate(model.distributions):
        near = distribution.within_reach(chroma, luma)
        _, log_density = distribution.distance(chroma.take(near, axis=0), luma.take(near))
        share = np.exp(log_density) * cell_volume(luma.take(near))
        share = share / max(float(share.sum()), LEAST)
        sureness = model.probability.take(near) / 255.0
        label = np.minimum(model.label.take(near), count)
        claims[color] = np.bincount(label, share * sureness, minlength=count + 1)
        claims[color, count] = 1.0 - claims[color, :count].sum()
    return claims
