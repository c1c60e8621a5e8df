"""The colors that a performer wears, as unmixing needs them: of each marker, and of all that is no marker."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import correlate1d

from ..arrays import Array, BoolArray, Image, IndexArray, SingleArray
from ..video.album import Album
from .appearance import CELL_VOLUME, LEVELS, NO_PART, UNSEEN, UNSEEN_LOG_DENSITY, Appearance, histogram_cells
from .unmixing import Surface, contrast, mixed, surface_of

NEAR_CELLS = 2  # cells around a common one that belong to its color
PART_DEVIATION = 5.0
APART = 12.0  # distance of colors that are two surfaces', in levels of `contrast`


def marker_surfaces(
    album: Album, centroid: Array, second_moment: Array, quality: Array
) -> list[Surface | None]:
    """The color of each of M markers in an album; None where it is never seen well enough.

    Arrays (F, M, ...) are those of `RegionTracks`.
    """
    return [
        _marker_surface(album, centroid[:, m], second_moment[:, m], quality[:, m])
        for m in range(quality.shape[1])
    ]


def _marker_surface(album: Album, centroid: Array, second_moment: Array, quality: Array) -> Surface | None:
    there = np.array([index in album for index in range(len(quality))])
    usual = np.where(there & np.isfinite(centroid[:, 0]), quality, 0.0)
    if not usual.any():
        return None
    # Well seen regions, where there are any.
    good = np.flatnonzero(usual >= min(0.6, float(np.median(usual[usual > 0.0]))))
    chosen = good[np.unique(np.linspace(0, len(good) - 1, 8).round().astype(np.intp))]
    inside = []
    for frame in chosen.tolist():
        picture = album.picture(frame)
        reach = np.sqrt(np.diagonal(second_moment[frame]).clip(0.0)) / album.factor
        low, high = (np.floor(centroid[frame] / album.factor + side * reach) for side in (-1.0, 1.0))
        left, top = np.clip(low, 0, picture.shape[1::-1]).astype(int).tolist()
        right, bottom = np.clip(high + 1, 0, picture.shape[1::-1]).astype(int).tolist()
        row, column = np.indices((max(bottom - top, 0), max(right - left, 0)))
        offset = (np.stack([column + left, row + top], axis=-1) + 0.5) * album.factor - centroid[frame]
        away = np.einsum("rci,ij,rcj->rc", offset, np.linalg.pinv(second_moment[frame]), offset)
        pixels = picture[top:bottom, left:right][away < 1.0]  # clear of the edge
        if len(pixels) >= 3:
            inside.append(pixels)
    return surface_of(np.concatenate(inside)) if inside else None


def common_colors(appearance: Appearance) -> tuple[Array, IndexArray]:
    """Common colors (K, 3), as of `contrast`, of parts, the commonest first, and those parts (K,)."""
    found: list[tuple[float, int, Array]] = []
    for part, log_density in enumerate(appearance.parts[:-1]):
        share = np.exp(log_density.astype(np.float64)) - 1.01 * np.exp(UNSEEN_LOG_DENSITY)
        share = np.maximum(share, 0.0).reshape(LEVELS, LEVELS, LEVELS) * CELL_VOLUME
        whole = share.sum()
        for _ in range(4):
            peak = np.unravel_index(int(share.argmax()), share.shape)
            near = tuple(slice(max(int(at) - NEAR_CELLS, 0), int(at) + NEAR_CELLS + 1) for at in peak)
            mass = float(share[near].sum())
            if mass < 0.07 * whole or mass == 0.0:  # of a part with at most four colors of its own
                break
            cells = np.moveaxis(np.indices(share[near].shape), 0, -1) + [one.start for one in near]
            color = (share[near][..., None] * (cells + 0.5)).sum(axis=(0, 1, 2)) * (256.0 / LEVELS) / mass
            found.append((mass / whole, part, color))
            share[near] = 0.0
    found.sort(key=lambda one: -one[0])
    color = contrast(np.array([color for *_, color in found]).reshape(-1, 3))
    return color, np.array([part for _, part, _ in found], dtype=np.intp)


def bare_surfaces(common: Array, markers: Sequence[Surface | None], beside: BoolArray) -> list[Surface]:
    """The body's surfaces that no marker covers: its common colors without the markers' own and their edges'.

    `beside` (K, M) says whether a color was seen on the limb that a marker is worn on.
    """
    worn = [one for one in markers if one is not None]
    bare: list[Surface] = []
    for color, near in zip(common, beside, strict=True):
        surface = Surface(color, PART_DEVIATION)
        known = np.array([one.color for one in (*worn, *bare)]).reshape(-1, 3)
        is_known = (np.linalg.norm(known - color, axis=-1) < APART).any()
        if is_known or any(is_alike(surface, one) for one in worn):
            continue
        neighbors = [one for one, there in zip(markers, near, strict=True) if there and one is not None]
        if not any(_is_blend(color, one, known) for one in neighbors):
            bare.append(surface)
    return bare


def _is_blend(color: Array, marker: Surface, known: Array) -> bool:
    """Whether a color is a mixture of a marker's with black, gray or a known one (K, 3)."""
    # What markers' edges are mixed with in front of most walls.
    ends = np.concatenate([np.zeros((1, 3)), np.array([60.0, 0.0, 0.0])[None], known])
    share, _ = mixed(color, ends, PART_DEVIATION, marker.color, PART_DEVIATION)
    at = ends + share[:, None] * (marker.color - ends)
    # Of a sleeve's shaded side, or edge.
    return bool(((share > 0.1) & (np.linalg.norm(at - color, axis=-1) < APART)).any())


def is_alike(one: Surface, other: Surface) -> bool:
    """Whether two surfaces' colors cannot be told apart."""
    return bool(np.linalg.norm(one.color - other.color) < 3.0 * max(one.deviation, other.deviation))


def usual_background(appearance: Appearance) -> SingleArray:
    """(rows, columns, 3) the background's colors; NaN where unknown."""
    known = appearance.known[..., None]
    return np.where(known, appearance.color, np.nan).astype(np.float32)


BANDS = 6  # bands of a part's length
BITS = 4  # coarser than whole parts' colors: a band has a sixth of their pixels
BAND_LEVELS = 1 << BITS
CELLS = BAND_LEVELS**3
SHARED = 0.25  # share of a band's colors that are the whole part's: folds and shadows wander


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
    bands = (1.0 - SHARED) * _densities(own) + SHARED * whole[:, None]
    anything = 0.5 * (whole.mean(axis=0) + _densities(background))
    return BandColors(np.log(bands), np.log(whole), np.log(anything))


def band_cells(pixels: Image) -> IndexArray:
    """Histogram cell of pixels (..., 3)."""
    return histogram_cells(pixels, BITS)


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
