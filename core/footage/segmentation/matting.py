"""Alpha matting: the share of each pixel that a region covers, which gives its border subpixel accuracy.

A border pixel mixes the region's color and its surroundings'; encoded colors mix linearly to a good
approximation. The share follows from the colors just inside and just outside, which makes areas unbiased
where a threshold would grow a region over dark neighbors and shrink it before bright ones.
"""

from typing import NamedTuple

import cv2
import numpy as np

from ...arrays import BoolArray, Image, IndexArray, SingleArray

WEIGHT = np.diag([1.0 / 9.0, 1.0, 1.0]).astype(np.float32)
"""Luma varies within a surface by its shading, so it says less about coverage than chroma does."""
SUM = np.ones((1, 3), dtype=np.float32)
CROSS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
REACH = (5, 5)
"""Sides, in halved pixels, of the squares that local colors are averaged over."""


class Coverage(NamedTuple):
    """Coverage of pixels by regions (alpha)."""

    pixel: IndexArray
    """(N,) flat indices of all pixels that may be covered."""
    share: SingleArray
    """(N,) float32 covered share of each, in 0..1."""


def coverage(image: Image, mask: Image) -> Coverage:
    """The share of each pixel that the masked regions cover.

    Computed in the band of two pixels to either side of a region's edge, in which optics and halved chroma
    blur edges; elsewhere the mask holds.

    Args:
        image: (rows, columns, 3) uint8 blue, green, red; rows and columns even.
        mask: (rows, columns) uint8, 1 in the classified regions.
    """
    first = cv2.erode(mask, CROSS)
    second = cv2.erode(first, CROSS)
    grown = cv2.dilate(mask, CROSS, iterations=2)
    # The deeper inside, the purer the color: squared depth, as the sum of the first odd numbers.
    depth = np.asarray(cv2.add(cv2.addWeighted(first, 3.0, second, 5.0, 0.0), mask), dtype=np.uint8)
    color = cv2.cvtColor(image, cv2.COLOR_BGR2YCrCb).astype(np.float32)
    inner, has_inner = _local_mean(color, depth)
    outer, has_outer = _local_mean(color, np.bitwise_xor(grown, 1).astype(np.uint8))
    axis = cv2.subtract(inner, outer)
    gain = cv2.transform(axis, WEIGHT)
    length = cv2.transform(cv2.multiply(axis, gain), SUM) + 1.0  # one squared level: less is the same color
    gain = cv2.divide(gain, cv2.merge([length] * 3))
    start = cv2.transform(cv2.multiply(outer, gain), SUM)
    start[~(has_inner & has_outer)] = np.nan

    pixel = np.flatnonzero(grown.view(np.bool_))
    row = pixel // mask.shape[1]
    near = (row >> 1) * start.shape[1] + ((pixel - row * mask.shape[1]) >> 1)
    product = color.reshape(-1, 3).take(pixel, axis=0) * gain.reshape(-1, 3).take(near, axis=0)
    along = product[:, 0] + product[:, 1] + product[:, 2] - start.take(near)
    mixed = (second.take(pixel) == 0) & (along == along)  # NaN where a side has no color
    share = np.where(mixed, np.minimum(np.maximum(along, 0.0), 1.0), mask.take(pixel))
    return Coverage(pixel, share)


def _local_mean(color: SingleArray, weight: Image) -> tuple[SingleArray, BoolArray]:
    """Weighted mean color around every two by two pixels, and whether there is any weight."""
    factor = weight.astype(np.float32)
    half = (weight.shape[1] // 2, weight.shape[0] // 2)
    weighted = cv2.resize(cv2.multiply(color, cv2.merge([factor] * 3)), half)
    weighted, total = cv2.blur(weighted, REACH), cv2.blur(cv2.resize(factor, half), REACH)
    divisor = np.maximum(total, 1e-6)
    return np.asarray(cv2.divide(weighted, cv2.merge([divisor] * 3)), dtype=np.float32), total > 1e-6
