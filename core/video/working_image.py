"""Working resolutions: grids for measuring, learning and searching, and the smoothing before classification.

An image is halved until it is just fine enough to measure on: halving is the fastest averaging. Markers are
searched on a coarser grid.
"""

import cv2
import numpy as np

from ..arrays import Image


def halvings(size: tuple[int, int]) -> int:
    """How often an image of (width, height) is halved for measuring."""
    return _halvings(max(size), 320)  # More accurate for borders than what body models predict


def measuring_image(image: Image, times: int) -> Image:
    """An image halved `times`; odd last columns and rows are left out."""
    for _ in range(times):
        rows, columns = image.shape[0] // 2, image.shape[1] // 2
        whole = image[: 2 * rows, : 2 * columns]
        image = np.asarray(cv2.resize(whole, (columns, rows), interpolation=cv2.INTER_AREA), dtype=np.uint8)
    return image


def learning_image(measuring: Image) -> Image:
    """Return a measuring image as colors are learned from it."""
    # A forearm has pixels clear of its blurred border.
    return measuring_image(measuring, _halvings(max(measuring.shape[:2]), 240))


def searching_factor(grid: tuple[int, int]) -> int:
    """By how much the grid of the search is coarser than the measuring one of (rows, columns)."""
    return 1 << _halvings(max(grid), 160)  # No marker of a measurable size is missed


def searching_image(image: Image, factor: int) -> Image:
    """The middle four pixels' mean of every square of `factor` by `factor`."""
    rows, columns = image.shape[0] // factor, image.shape[1] // factor
    whole = image[: rows * factor, : columns * factor]
    return np.asarray(cv2.resize(whole, (columns, rows), interpolation=cv2.INTER_LINEAR), dtype=np.uint8)


def smooth(image: Image) -> Image:
    """Average about one pixel to each side: decoders hold chroma at half the resolution of luma anyway."""
    return np.asarray(cv2.GaussianBlur(image, (3, 3), 0.0), dtype=np.uint8)


def _halvings(columns: int, fewest: int) -> int:
    """How often some columns can be halved and leave no fewer than the fewest."""
    times = 0
    while columns >> (times + 1) >= fewest:
        times += 1
    return times
