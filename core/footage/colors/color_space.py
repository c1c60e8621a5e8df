"""Color space: chromaticity, which is free of shading, and the cells of color histograms.

A surface in shadow keeps the ratios of its channels, and both gamma-encoded luma and chroma scale with the
light to a good approximation; chroma over luma therefore describes the surface, and luma the light on it. A
small offset keeps dark pixels, whose ratios are noise, near gray.
"""

import cv2
import numpy as np
from numpy.typing import ArrayLike

from ...arrays import Array, Image, IndexArray, Int32Array, SingleArray

CELL_BITS = 6
"""Bits kept of each channel: 64³ cells hold a color to within two levels, less than compression noise."""
CELLS_PER_CHANNEL = 1 << CELL_BITS
CELL_COUNT = CELLS_PER_CHANNEL**3
CELL_WIDTH = 256 // CELLS_PER_CHANNEL

LUMA_OFFSET = 16.0
"""Levels added to luma before dividing by it: about five times the noise of a compressed dark pixel."""

# Recommendation ITU-R BT.601, full range, as video decoders' 4:2:0 chroma is split.
LUMA_BGR = np.array([0.114, 0.587, 0.299])
BLUE_SCALE = 0.564
RED_SCALE = 0.713


def chromaticity(bgr: ArrayLike) -> tuple[Array, Array]:
    """Split colors into chromaticity and luma.

    Args:
        bgr: (..., 3) in 0..255, blue, green, red, gamma-encoded.

    Returns:
        Chromaticity (..., 2), blue and red difference over offset luma, without unit; offset luma (...) in
        levels.
    """
    color = np.asarray(bgr, dtype=np.float64)
    # Written out: for so short a product, linear algebra libraries start threads that only wait.
    luma = color[..., 0] * LUMA_BGR[0] + color[..., 1] * LUMA_BGR[1] + color[..., 2] * LUMA_BGR[2]
    offset_luma = luma + LUMA_OFFSET
    differences = np.stack([(color[..., 0] - luma) * BLUE_SCALE, (color[..., 2] - luma) * RED_SCALE], axis=-1)
    return differences / offset_luma[..., None], offset_luma


def cell_volume(offset_luma: ArrayLike) -> Array:
    """The volume of a cell in (chromaticity, log luma), for densities counted by cells."""
    luma = np.asarray(offset_luma)
    # d(blue, red difference, luma) / d(b, g, r) has the determinant 0.564 · 0.713 · 0.587; the division
    # scales it.
    return np.asarray(CELL_WIDTH**3 * BLUE_SCALE * RED_SCALE * LUMA_BGR[1] / luma**3)


def cell_index(image: Image) -> IndexArray:
    """The cell of every pixel, (rows, columns) in 0..CELL_COUNT-1, of a (rows, columns, 3) image."""
    packed = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2BGRA)).view("<u4")[..., 0]
    cut, last = 8 - CELL_BITS, CELLS_PER_CHANNEL - 1
    index = (packed >> cut) & last
    index |= (packed >> 2 * cut) & (last << CELL_BITS)
    index |= (packed >> 3 * cut) & (last << 2 * CELL_BITS)
    return index.astype(np.intp)


def cell_colors(cells: Int32Array | None = None) -> Array:
    """Centers of cells, (..., 3) blue, green, red in levels; of all cells by default."""
    index = np.arange(CELL_COUNT, dtype=np.int32) if cells is None else cells
    last = CELLS_PER_CHANNEL - 1
    levels = np.stack([index & last, index >> CELL_BITS & last, index >> 2 * CELL_BITS], axis=-1)
    return np.asarray(levels * float(CELL_WIDTH) + (CELL_WIDTH - 1) / 2.0)


def cell_chromaticity(cells: Int32Array) -> tuple[SingleArray, SingleArray]:
    """Chromaticity (N, 2) and offset luma (N,) of the centers of cells.

    Single precision is plenty for a color and takes half the time.
    """
    levels = np.arange(CELLS_PER_CHANNEL, dtype=np.float32) * CELL_WIDTH + (CELL_WIDTH - 1) / 2
    last = CELLS_PER_CHANNEL - 1
    blue, red = levels.take(cells & last), levels.take(cells >> 2 * CELL_BITS)
    luma = levels.take(cells >> CELL_BITS & last) * np.float32(LUMA_BGR[1])
    luma += blue * np.float32(LUMA_BGR[0]) + red * np.float32(LUMA_BGR[2])
    offset_luma = luma + np.float32(LUMA_OFFSET)
    chroma = np.empty((len(cells), 2), dtype=np.float32)
    chroma[:, 0] = (blue - luma) * np.float32(BLUE_SCALE) / offset_luma
    chroma[:, 1] = (red - luma) * np.float32(RED_SCALE) / offset_luma
    return chroma, offset_luma
