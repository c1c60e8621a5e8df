"""The strong colors of clips, with names of their hues, as candidates for the markers' colors."""

from collections.abc import Iterable
from colorsys import rgb_to_hsv
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Image
from ..numerics.vectors import weighted_median
from ..video.working_image import learning_image, smooth
from .color_model import (
    CELL_COUNT,
    LUMA_OFFSET,
    ColorModel,
    cell_chromaticity,
    cell_colors,
    cell_index,
    cell_volume,
    chromaticity,
)

HUES = "red 15, orange 42, yellow 70, green 165, cyan 200, blue 255, purple 290, pink 340, red 360"
"""Hues with their upper bounds [degrees]."""


@dataclass(frozen=True)
class StrongColor:
    """A salient color."""

    color_srgb: tuple[int, int, int]  # (red, green, blue) in 0..255, the median of its pixels
    share: float  # share of the pixels that have it

    @property
    def hue(self) -> str:
        """Common name of its hue."""
        red, green, blue = self.color_srgb
        degrees = 360.0 * rgb_to_hsv(red / 255.0, green / 255.0, blue / 255.0)[0]
        named = (one.split() for one in HUES.split(", "))
        return next(name for name, end in named if degrees <= float(end))


def strong_colors(images: Iterable[Image]) -> tuple[StrongColor, ...]:
    """The strongest colors of images on the measuring grid, the most salient first."""
    counts = np.zeros(CELL_COUNT)
    for image in images:
        cells = cell_index(smooth(learning_image(image)))
        counts += np.bincount(cells.ravel(), minlength=CELL_COUNT)
    present = np.flatnonzero(counts).astype(np.int32)
    colors = cell_colors(present)
    chroma, luma = chromaticity(colors)
    strong = (np.linalg.norm(chroma, axis=1) > 0.2) & (luma > 25.0 + LUMA_OFFSET)
    colors, chroma = colors[strong], chroma[strong]
    left, least = counts[present][strong], 2e-4 * counts.sum()
    found: list[tuple[float, StrongColor]] = []
    while left.sum() > least:
        square = np.round(chroma / 0.04).astype(np.int64)
        _, index = np.unique(square[:, 0] * 10_000 + square[:, 1], return_inverse=True)
        densest = index == int(np.bincount(index, left).argmax())
        center = np.average(chroma[densest], axis=0, weights=left[densest])
        near = np.linalg.norm(chroma - center, axis=1) < 0.10
        share = float(left[near].sum() / counts.sum())
        if share > 2e-4:
            blue, green, red = (round(weighted_median(channel, left[near])) for channel in colors[near].T)
            # Blends at borders are many and dull; a marker is small and strong.
            standing_out = float(np.linalg.norm(center)) * share**0.25
            found.append((standing_out, StrongColor((red, green, blue), share)))
        left[near] = 0.0
    found.sort(key=lambda one: -one[0])
    return tuple(color for _, color in found[:12])  # markers, skin, and things in the room


def color_confusion(model: ColorModel) -> Array:
    """Confusion matrix (C, C + 1): shares of each color's pixels classified as each color, and as background.

    Pixels drawn from a color's learned density count by the posterior probability of their cells, as in
    tracking; rows sum to 1.
    """
    cells = np.arange(len(model.label), dtype=np.int32)
    chroma, luma = cell_chromaticity(cells)
    count = len(model.distributions)
    claims = np.zeros((count, count + 1))
    for color, distribution in enumerate(model.distributions):
        near = distribution.within_reach(chroma, luma)
        _, log_density = distribution.distance(chroma.take(near, axis=0), luma.take(near))
        share = np.exp(log_density) * cell_volume(luma.take(near))
        share = share / max(float(share.sum()), 1e-300)
        sureness = model.probability.take(near) / 255.0
        label = np.minimum(model.label.take(near), count)
        claims[color] = np.bincount(label, share * sureness, minlength=count + 1)
        claims[color, count] = 1.0 - claims[color, :count].sum()
    return claims
