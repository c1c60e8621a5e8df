"""All regions of one image that have a marker's colour, measured to a fraction of a pixel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from .colour_model import ColourModel
from .matting import coverage
from .moments import raw_moments
from .working_image import measuring_factor, reduce, searching_factor, smooth

FloatArray = NDArray[np.float64]
Image = NDArray[np.uint8]

MOST_REGIONS: Final = 8
"""Regions kept of each marker in a frame, the largest; a clip's memory is bounded by it."""
_SURE: Final = 230
"""A region must hold pixels this sure (in 1/255) to be more than a blend of other colours."""
_FEWEST_PIXELS: Final = 6
_BORDER: Final = 2
"""Half-width in grid pixels of the band in which edges are blurred, by optics and halved chroma."""
_KERNEL: Final = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (3, 3))


@dataclass(frozen=True, eq=False)
class Region:
    """One connected region of a marker's colour.

    Attributes:
        moments: (6,) raw moments m00, m10, m01, m20, m11, m02 in the image's pixels.
        box: (4,) left, top, right, bottom in pixels.
        certainty: mean probability of its pixels' colour in 0..1.
        clipped: whether it touches the image's border.
    """

    moments: FloatArray
    box: FloatArray
    certainty: float
    clipped: bool


def find_regions(image: Image, model: ColourModel) -> list[list[Region]]:
    """Return the regions of each marker's colour in an image (rows, columns, 3), the largest first.

    Regions are found on a coarse grid and measured on a finer one, in the windows that hold them.
    """
    scale = measuring_factor((image.shape[1], image.shape[0]))
    measuring = reduce(image, scale)
    factor = searching_factor((measuring.shape[1], measuring.shape[0]))
    label, probability = model.classify(smooth(reduce(measuring, factor)))
    found: list[list[Region]] = []
    for marker in range(len(model.distributions)):
        boxes = _merged(_boxes(label, probability, marker, factor), 4 * factor)
        regions = [region for box in boxes for region in _measure(measuring, model, marker, box, factor)]
        regions.sort(key=lambda region: -region.moments[0])
        found.append([_enlarged(region, scale) for region in regions[:MOST_REGIONS]])
    return found


def marker_masks(image: Image, model: ColourModel) -> NDArray[np.float32]:
    """Return the coverage of each pixel by each marker's colour, (M, rows, columns) in 0..1, for previews."""
    height, width = image.shape[:2]
    measuring = reduce(image, measuring_factor((width, height)))
    label, probability = model.classify(smooth(measuring))
    shares = []
    for marker in range(len(model.distributions)):
        components, stats = _clean(label == marker, probability)
        shares.append(coverage(measuring, np.isin(components, stats[:, 0]), _BORDER))
    if measuring.shape == image.shape:
        return np.stack(shares)
    return np.stack([np.asarray(cv2.resize(share, (width, height)), dtype=np.float32) for share in shares])


def _enlarged(region: Region, scale: int) -> Region:
    """Return a region of the measuring grid in the image's own pixels."""
    powers = float(scale) ** np.array([2, 3, 3, 4, 4, 4])
    return Region(region.moments * powers, region.box * scale, region.certainty, region.clipped)


def _clean(
    mask: NDArray[np.bool_], probability: NDArray[np.uint8]
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Close one-pixel holes and tell specks and regions without a sure core from the rest.

    Returns:
        The number of each pixel's connected region (rows, columns); and of the regions to keep the number,
        left, top, width, height and area, (N, 6).
    """
    closed = cv2.morphologyEx(mask.view(np.uint8), cv2.MORPH_CLOSE, _KERNEL)
    count, components, stats, _ = cv2.connectedComponentsWithStats(closed, connectivity=8)
    sure = np.bincount(components[mask & (probability >= _SURE)], minlength=count)
    good = (stats[:, cv2.CC_STAT_AREA] >= _FEWEST_PIXELS) & (sure >= 2)
    good[0] = False
    kept = np.flatnonzero(good)
    return np.asarray(components, dtype=np.int32), np.column_stack([kept, stats[kept]])


def _boxes(
    label: NDArray[np.uint8], probability: NDArray[np.uint8], marker: int, factor: int
) -> list[tuple[int, int, int, int]]:
    """Return left, top, right, bottom of a marker's cleaned regions, in pixels of the measuring grid."""
    mask = label == marker
    x, y, columns, rows = cv2.boundingRect(mask.view(np.uint8))
    if not columns:
        return []
    inside = np.s_[y : y + rows, x : x + columns]
    _, stats = _clean(np.ascontiguousarray(mask[inside]), probability[inside])
    _, left, top, width, height, area = stats.T
    corners = np.stack([x + left, y + top, x + left + width, y + top + height], axis=-1) * factor
    largest = np.argsort(-area)[: 2 * MOST_REGIONS]
    return [(int(a), int(b), int(c), int(d)) for a, b, c, d in corners[largest]]


def _merged(boxes: Sequence[tuple[int, int, int, int]], gap: int) -> list[tuple[int, int, int, int]]:
    """Join boxes that overlap once grown by a gap, so that no pixel is measured twice."""
    pending, merged = list(boxes), []
    while pending:
        a, b, c, d = pending.pop()
        for other in pending:
            if a - gap <= other[2] and other[0] <= c + gap and b - gap <= other[3] and other[1] <= d + gap:
                pending.remove(other)
                pending.append((min(a, other[0]), min(b, other[1]), max(c, other[2]), max(d, other[3])))
                break
        else:
            merged.append((a, b, c, d))
    return merged


def _measure(
    image: Image, model: ColourModel, marker: int, box: tuple[int, int, int, int], factor: int
) -> list[Region]:
    """Classify a window of the measuring grid anew and measure its regions, in pixels of that grid."""
    height, width = image.shape[:2]
    margin = 2 * _BORDER + factor
    left, top = max(box[0] - margin, 0), max(box[1] - margin, 0)
    right, bottom = min(box[2] + margin, width), min(box[3] + margin, height)
    window = image[top:bottom, left:right]
    label, probability = model.classify(smooth(window))
    components, stats = _clean(label == marker, probability)
    if not len(stats):
        return []
    inside = components == stats[0, 0] if len(stats) == 1 else np.isin(components, stats[:, 0])
    share = coverage(window, inside, _BORDER)
    owner = components if len(stats) == 1 else _nearest_component(np.where(inside, components, 0))
    regions = []
    for component, x, y, columns, rows, _ in stats.tolist():
        weights = share if len(stats) == 1 else np.where(owner == component, share, 0.0)
        corners = np.array([left + x, top + y, left + x + columns, top + y + rows], dtype=np.float64)
        moments = raw_moments(weights, (left, top))
        if moments[0] < _FEWEST_PIXELS:
            continue
        certainty = float(probability[components == component].mean()) / 255.0
        clipped = bool(corners[0] <= 0 or corners[1] <= 0 or corners[2] >= width or corners[3] >= height)
        regions.append(Region(moments, corners, certainty, clipped))
    return regions


def _nearest_component(components: NDArray[np.int32]) -> NDArray[np.int32]:
    """Give every pixel to the nearest component, to share out the coverage beyond their edges."""
    outside = (components == 0).astype(np.uint8)
    _, nearest = cv2.distanceTransformWithLabels(outside, cv2.DIST_L2, 3, labelType=cv2.DIST_LABEL_CCOMP)
    inside = components > 0
    translate = np.zeros(int(nearest.max()) + 1, dtype=np.int32)
    translate[nearest[inside]] = components[inside]
    return np.asarray(translate[nearest])
