"""The colors along each part of the body, band by band: cuffs, shoe lines and belts."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import correlate1d

from ..arrays import Array, Image, IndexArray
from .appearance import NO_PART, UNSEEN, histogram_cells

BANDS = 6  # bands of a part's length
BAND_LEVELS = 16  # coarser than whole parts' colors: a band has a sixth of their pixels
CELLS = BAND_LEVELS**3


@dataclass(frozen=True, eq=False)
class BandColors:
    """Log likelihoods of colors, as densities per cell."""

    bands: Array  # (O, BANDS, cells) of each part's bands
    parts: Array  # (O, cells) of whole parts
    anything: Array  # (cells,) of performer and background together


def learn_band_colors(
    images: list[Image], labels: list[NDArray[np.int8]], shares: list[Array], count: int
) -> BandColors:
    """Learn the colors along all O parts, from frames and labels as in `learn_appearance`.

    `shares` are (rows, columns) the place along the visible part, from 0 to 1 between its ends; NaN where it
    is seen end on.
    """
    size = count * BANDS * CELLS
    counts, background = np.zeros(size), np.zeros(CELLS)
    for image, label, share in zip(images, labels, shares, strict=True):
        cell = band_cells(image)
        inside = (label != NO_PART) & np.isfinite(share)
        band = np.clip(share[inside] * BANDS, 0, BANDS - 1).astype(np.intp)
        where = (label[inside].astype(np.intp) * BANDS + band) * CELLS + cell[inside]
        counts += np.bincount(where, minlength=size)
        background += np.bincount(cell[label == NO_PART], minlength=CELLS)
    own = counts.reshape(count, BANDS, CELLS)
    whole = _densities(own.sum(axis=1))
    bands = 0.75 * _densities(own) + 0.25 * whole[:, None]  # folds and shadows wander
    anything = 0.5 * (whole.mean(axis=0) + _densities(background))
    return BandColors(np.log(bands), np.log(whole), np.log(anything))


def band_cells(pixels: Image) -> IndexArray:
    """Histogram cell of pixels (..., 3)."""
    return histogram_cells(pixels, 4)


def _densities(counts: Array) -> Array:
    """Densities per cell of smoothed histograms (..., cells); an empty one is even."""
    grid = counts.reshape(*counts.shape[:-1], BAND_LEVELS, BAND_LEVELS, BAND_LEVELS)
    for axis in (-3, -2, -1):
        # Noise of a few levels.
        grid = correlate1d(grid, np.array([0.16, 0.68, 0.16]), axis=axis, mode="nearest")
    smoothed = grid.reshape(counts.shape)
    total = smoothed.sum(axis=-1, keepdims=True)
    share = np.where(total > 0.0, smoothed / np.maximum(total, 1.0), 1.0 / CELLS)
    return np.asarray((1.0 - UNSEEN) * share + UNSEEN / CELLS)
