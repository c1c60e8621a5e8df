"""Moments of an image region and the four characteristics read from them.

The paper's section 3.1: zero-, first- and second-order moments (eq. 1), the second central moment matrix A
over m00 (eq. 2), and the centroid, the direction of the major axis and the ratio of the eigenvalues (eqs. 3
to 6). Pixels are unit squares in the image convention of the project: the first pixel covers [0, 1] x [0, 1]
and its center is (0.5, 0.5).
"""

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, BoolArray, Image, IndexArray, SingleArray

PIXEL_VARIANCE = 1.0 / 12.0  # variance along each axis of a unit square of even weight, in px²

MOMENT_POWERS = np.array([2, 3, 3, 4, 4, 4])
"""Of a length, that the raw moments m00, m10, m01, m20, m11, m02 grow with."""


class Characteristics(NamedTuple):
    """The characteristics of one or more regions; fields (...)."""

    x: Array  # S_x, the centroid's column in pixels
    y: Array  # S_y, the centroid's row in pixels, downwards
    angle_rad: Array
    """S_θ in (-π/2, π/2], from the image's x axis towards its y axis (downwards); meaningful modulo π."""
    ratio: Array  # S_λ = λ1/λ2 >= 1, of the squared axes


def centroid_and_second_moment(moments: ArrayLike) -> tuple[Array, Array]:
    """Centroids (..., 2) and A = [[μ20, μ11], [μ11, μ02]] / m00 (..., 2, 2) of raw moments (..., 6).

    Eqs. 2 to 4, in px; NaN where m00 is zero. Moments of disjoint regions add up.
    """
    m = np.asarray(moments, dtype=np.float64)
    area = np.where(m[..., 0] > 0.0, m[..., 0], np.nan)[..., None]
    centroid = m[..., 1:3] / area
    second = m[..., 3:6] / area
    x, y = centroid[..., 0], centroid[..., 1]
    cross = second[..., 1] - x * y
    matrix = np.stack([second[..., 0] - x**2, cross, cross, second[..., 2] - y**2], axis=-1)
    return centroid, matrix.reshape(*matrix.shape[:-1], 2, 2)


def characteristics(centroid: ArrayLike, second_moment: ArrayLike) -> Characteristics:
    """S_x, S_y, S_θ, S_λ of regions with centroids (..., 2) [px] and A (..., 2, 2) [px²].

    S_θ is the direction of the eigenvector of the larger eigenvalue λ1: the printed eq. 5 names λ2, but the
    sentence after it says major axis, and that is λ1's. S_λ = λ1/λ2 (eq. 6) is the square of the ratio of the
    axes.
    """
    centroid = np.asarray(centroid, dtype=np.float64)
    matrix = np.asarray(second_moment, dtype=np.float64)
    mean = (matrix[..., 0, 0] + matrix[..., 1, 1]) / 2.0
    difference = (matrix[..., 0, 0] - matrix[..., 1, 1]) / 2.0
    cross = matrix[..., 0, 1]
    spread = np.hypot(difference, cross)  # (λ1 - λ2) / 2
    larger = mean + spread
    # The product of the eigenvalues over the larger one keeps its digits where mean - spread would cancel.
    smaller = (matrix[..., 0, 0] * matrix[..., 1, 1] - cross**2) / np.where(larger > 0.0, larger, np.nan)
    angle = np.arctan2(cross, difference) / 2.0
    ratio = larger / np.where(smaller > 0.0, smaller, np.nan)
    return Characteristics(centroid[..., 0], centroid[..., 1], angle, ratio)


def axis_angle_difference(first: ArrayLike, second: ArrayLike) -> Array:
    """The difference first - second wrapped to [-π/2, π/2): an axis has no head, so angles count modulo π."""
    difference = np.asarray(first, dtype=np.float64) - np.asarray(second, dtype=np.float64)
    return np.asarray((difference + np.pi / 2.0) % np.pi - np.pi / 2.0)


WEIGHT = np.diag([1.0 / 9.0, 1.0, 1.0]).astype(np.float32)
"""Luma varies within a surface by its shading, so it says less about coverage than chroma does."""
CROSS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))


class Coverage(NamedTuple):
    """Coverage of pixels by regions (alpha)."""

    pixel: IndexArray  # (N,) flat indices of all pixels that may be covered
    share: SingleArray  # (N,) float32 covered share of each, in 0..1


def coverage(image: Image, mask: Image) -> Coverage:
    """The share of each pixel of an image, with even rows and columns, that the masked regions (1) cover.

    Computed in the band of two pixels to either side of a region's edge, in which optics and halved chroma
    blur edges; elsewhere the mask holds.
    """
    first = cv2.erode(mask, CROSS)
    second = cv2.erode(first, CROSS)
    grown = cv2.dilate(mask, CROSS, iterations=2)
    # The deeper inside, the purer the color: squared depth, as the sum of the first odd numbers.
    depth = np.asarray(cv2.add(cv2.addWeighted(first, 3.0, second, 5.0, 0.0), mask), dtype=np.uint8)
    color = cv2.cvtColor(image, cv2.COLOR_BGR2YCrCb).astype(np.float32)
    inner, has_inner = _local_mean(color, depth)
    outer, has_outer = _local_mean(color, np.bitwise_xor(grown, 1).astype(np.uint8))
    axis, summed = cv2.subtract(inner, outer), np.ones((1, 3), dtype=np.float32)
    gain = cv2.transform(axis, WEIGHT)
    # One squared level: less is the same color.
    length = cv2.transform(cv2.multiply(axis, gain), summed) + 1.0
    gain = cv2.divide(gain, cv2.merge([length] * 3))
    start = cv2.transform(cv2.multiply(outer, gain), summed)
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
    # Over squares of five halved pixels.
    weighted, total = cv2.blur(weighted, (5, 5)), cv2.blur(cv2.resize(factor, half), (5, 5))
    divisor = np.maximum(total, 1e-6)
    return np.asarray(cv2.divide(weighted, cv2.merge([divisor] * 3)), dtype=np.float32), total > 1e-6
