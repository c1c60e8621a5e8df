"""Region detection: all regions of the markers' colors in an image, measured with subpixel accuracy."""

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..arrays import Array, BoolArray, Image, IntArray, SingleArray
from ..video.working_image import halvings, measuring_image, searching_factor, searching_image, smooth
from .color_model import BACKGROUND, ColorModel, cell_index
from .ignored_regions import is_ignored, without
from .moments import CROSS, MOMENT_POWERS, PIXEL_VARIANCE, Coverage, coverage
from .region_tracks import NO_REGIONS, Regions

Box = tuple[int, int, int, int]

MARGIN = 6  # margin in px around a measured box: the border band, and enough background to know its color


def colored_boxes(label: Image, color: int, factor: int) -> list[Box]:
    """Boxes around a color's components on a grid `factor` as coarse as the measuring one, in its pixels."""
    mask = np.equal(label, color).view(np.uint8)
    x, y, columns, rows = cv2.boundingRect(mask)
    if not columns:
        return []
    part = np.ascontiguousarray(mask[y : y + rows, x : x + columns])
    _, _, stats, _ = cv2.connectedComponentsWithStats(part, connectivity=8, ltype=cv2.CV_16U)
    stats = stats[1:]
    if len(stats) > 12:  # those with most pixels of it are kept
        stats = stats[np.argsort(-stats[:, cv2.CC_STAT_AREA], kind="stable")[:12]]
    return [
        ((x + a) * factor, (y + b) * factor, (x + a + c) * factor, (y + b + d) * factor)
        for a, b, c, d, _ in stats.tolist()
    ]


def boxes_to_measure(seen: Sequence[Box], followed: Sequence[Box]) -> list[Box]:
    """Boxes seen, and those of the frame before that none of them shows, too small for the coarse grid.

    Those that overlap with their margins are merged: no pixel is measured twice for a color.
    """

    def overlap(first: Box, second: Box, gap: int) -> bool:
        across = first[0] - gap < second[2] and second[0] < first[2] + gap
        return across and first[1] - gap < second[3] and second[1] < first[3] + gap

    pending = list(seen) + [box for box in followed if not any(overlap(box, other, 0) for other in seen)]
    boxes = []
    while pending:
        a, b, c, d = pending.pop()
        for other in pending:
            if overlap((a, b, c, d), other, 2 * MARGIN):
                pending.remove(other)
                pending.append((min(a, other[0]), min(b, other[1]), max(c, other[2]), max(d, other[3])))
                break
        else:
            boxes.append((a, b, c, d))
    return boxes


class Window(NamedTuple):
    """A window of an image to search for a color, in pixels of the image halved `times`."""

    image: int
    times: int
    color: int
    left: int
    top: int
    right: int
    bottom: int


class Atlas(NamedTuple):
    """Windows side by side, their tops at the atlas's first row, with a column between them."""

    picture: Image  # (rows, columns, 3) uint8, rows and columns even
    image: IntArray  # (columns,) int64, index of each column's image
    color: Image  # (columns,) uint8, index of the color to search for; between panels 254, which no pixel has
    height: IntArray  # (columns,) rows in use
    shift: IntArray  # (2, columns) offset of a column, and of its rows, to the halved image
    scale: IntArray  # (columns,) pixels of the image to one of the atlas
    ignored: BoolArray | None = None  # (rows, columns) pixels that are no region's; None where there are none


def pack_windows(
    images: Sequence[Image], windows: Sequence[Window], masks: Sequence[Image | None] = ()
) -> Atlas:
    """Cut windows out of images of one size and of the masks of their ignored pixels; lay them side by side.

    The masks are of images halved as the windows are; empty for none. Each window overlaps its image.
    """
    height = max(window.bottom - window.top for window in windows)
    width = sum(window.right - window.left + 1 for window in windows)
    height, width = height + height % 2, width + width % 2
    picture = np.zeros((height, width, 3), dtype=np.uint8)
    color = np.full(width, 254, dtype=np.uint8)
    image, used = np.zeros((2, width), dtype=np.int64)
    shift, scale = np.zeros((2, width), dtype=np.int64), np.ones(width, dtype=np.int64)
    ignored = np.zeros((height, width), dtype=np.uint8) if any(mask is not None for mask in masks) else None
    start = 0
    for window in windows:
        columns, rows = window.right - window.left, window.bottom - window.top
        end = start + columns
        picture[:, start : end + 1] = _cut(images[window.image], window, height)
        mask = masks[window.image] if ignored is not None else None
        if ignored is not None and mask is not None:
            ignored[:, start : end + 1] = _cut(mask, window._replace(times=0), height)
        # Smoothing mixes the first column with the panel to its left.
        color[start + 1 : end] = window.color
        panel = slice(start, end + 1)
        image[panel], used[panel], scale[panel] = window.image, rows, 1 << window.times
        shift[0, panel], shift[1, panel] = window.left - start, window.top
        start = end + 1
    hidden = None if ignored is None else is_ignored(ignored)
    return Atlas(picture, image, color, used, shift, scale, hidden)


def _cut(image: Image, window: Window, height: int) -> Image:
    """Return a window of an image, extended to a height and by a column; all beyond repeats the border."""
    _, times, _, left, top, right, bottom = window
    rows, columns = image.shape[0] >> times, image.shape[1] >> times
    a, b, c, d = max(left, 0), max(top, 0), min(right, columns), min(bottom, rows)
    cut = measuring_image(image[b << times : d << times, a << times : c << times], times)
    around = (b - top, top + height - d, a - left, right + 1 - c)
    return np.asarray(cv2.copyMakeBorder(cut, *around, cv2.BORDER_REPLICATE), dtype=np.uint8)


FEWEST_PIXELS = 6


def find_regions(
    images: Sequence[Image],
    times: int,
    model: ColorModel,
    before: Regions = NO_REGIONS,
    ignored: Sequence[Image | None] = (),
) -> list[Regions]:
    """Detect the regions of the markers' colors in each of some successive images of one size.

    A search on a coarse grid finds the windows to measure; those around the regions of the frame before are
    added. Only these are segmented finely. Several images together take less time than one by one. Halved
    `times`, the images become the measuring grid, on which are the masks of their ignored pixels, if any.
    """
    grid = (images[0].shape[0] >> times, images[0].shape[1] >> times)
    factor = searching_factor(grid)
    label = model.labels(np.concatenate([searching_image(image, factor << times) for image in images]))
    followed: list[list[Box]] = [[] for _ in model.distributions]
    for color, (left, top, right, bottom) in zip(before.color.tolist(), before.box.tolist(), strict=True):
        followed[color].append((left, top, right, bottom))
    windows: list[Window] = []
    parts = np.split(label, len(images))
    for number, mask in enumerate(ignored):
        if mask is not None:
            parts[number] = without(parts[number], searching_image(mask, factor), BACKGROUND)
    for number, part in enumerate(parts):
        for color, boxes in enumerate(followed):
            seen = colored_boxes(part, color, factor)
            for left, top, right, bottom in boxes_to_measure(seen, boxes):
                box = (left - MARGIN, top - MARGIN, right + MARGIN, bottom + MARGIN)
                windows.append(Window(number, times, color, *box))
    if not windows:
        return [NO_REGIONS] * len(images)
    return _measure(pack_windows(images, windows, ignored), images[0].shape, times, len(images), model)


def color_masks(image: Image, model: ColorModel, ignored: Image | None = None) -> SingleArray:
    """Coverage (C, rows, columns) of the measuring grid by each color, as tracking measures it."""
    grid = measuring_image(image, halvings((image.shape[1], image.shape[0])))
    label = model.labels(smooth(grid))
    if ignored is not None:
        label = without(label, ignored, BACKGROUND)
    masks = np.zeros((len(model.distributions), *grid.shape[:2]), dtype=np.float32)
    for color, mask in enumerate(masks):
        left, top, columns, rows = cv2.boundingRect(np.equal(label, color).view(np.uint8))
        if not columns:
            continue
        around = (left - MARGIN, top - MARGIN, left + columns + MARGIN, top + rows + MARGIN)
        atlas = pack_windows([grid], [Window(0, 0, color, *around)], [ignored])
        covered = _coverage(atlas, _components(atlas, model))
        share = np.zeros(atlas.picture.shape[:2], dtype=np.float32)
        share.ravel()[covered.pixel] = covered.share
        a, b, c, d = np.clip(around, 0, (*grid.shape[1::-1], *grid.shape[1::-1])).tolist()
        mask[b:d, a:c] = share[b - around[1] : d - around[1], a - around[0] : c - around[0]]
    return masks


class _Components(NamedTuple):
    """K connected components of an atlas that are measured."""

    number: NDArray[np.uint16]  # (rows, columns) uint16, the component of each pixel, from 1; 0 for none
    box: IntArray  # (K, 4) left, top, right, bottom on the atlas
    certainty: Array  # (K,) mean probability of the pixels' color in 0..1
    cut: BoolArray
    """(K,) whether ignored pixels of its color touch it: it is seen in part, as at the image's border."""


def _components(atlas: Atlas, model: ColorModel) -> _Components:
    """Connected components of each panel's color, holes of a pixel closed, without specks and unsure ones."""
    cells = cell_index(smooth(atlas.picture))
    label, probability = model.label.take(cells), model.probability.take(cells)
    used = np.arange(len(label))[:, None] < atlas.height
    mask = ((label == atlas.color) & used).view(np.uint8)
    closed = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, CROSS)
    if atlas.ignored is not None:
        hidden = np.flatnonzero(closed.view(np.bool_) & atlas.ignored)
        closed = np.where(atlas.ignored, np.uint8(0), closed)
    count, number, stats, _ = cv2.connectedComponentsWithStats(closed, connectivity=8, ltype=cv2.CV_16U)
    pixel = np.flatnonzero(closed.view(np.bool_))
    region, sureness = number.take(pixel), probability.take(pixel)
    sure = np.bincount(region[sureness >= 230], minlength=count)  # blends of other colors have less
    good = (stats[:, cv2.CC_STAT_AREA] >= FEWEST_PIXELS) & (sure >= 2)
    good[0] = False
    kept = np.flatnonzero(good)
    certainty = np.bincount(region, weights=sureness, minlength=count)[kept] / 255.0
    left, top, width, height, area = stats[kept].T.astype(np.int64)
    renumbered = np.zeros(count, dtype=np.uint16)
    renumbered[kept] = np.arange(1, len(kept) + 1)
    box = np.stack([left, top, left + width, top + height], axis=-1)
    numbered, cut = renumbered.take(np.asarray(number)), np.zeros(len(kept) + 1, dtype=np.bool_)
    if atlas.ignored is not None:
        cut[np.asarray(cv2.dilate(numbered, CROSS)).take(hidden)] = True
    return _Components(numbered, box, certainty / area, cut[1:])


def _coverage(atlas: Atlas, found: _Components) -> Coverage:
    """The share of each pixel that the components cover; none of the ignored ones."""
    covered = coverage(atlas.picture, np.minimum(found.number, 1).astype(np.uint8))
    if atlas.ignored is None:
        return covered
    return covered._replace(share=covered.share * ~atlas.ignored.take(covered.pixel))


def _measure(
    atlas: Atlas, shape: tuple[int, ...], times: int, images: int, model: ColorModel
) -> list[Regions]:
    """Measure the regions on a atlas, in pixels of the grid that images of a shape halved `times` make."""
    found = _components(atlas, model)
    covered = _coverage(atlas, found)
    # Pixels in the band beyond the edges belong to the region beside it.
    owner = np.asarray(cv2.dilate(found.number, CROSS, iterations=2), dtype=np.uint16).take(covered.pixel)
    row = covered.pixel // len(atlas.color)
    column = covered.pixel - row * len(atlas.color)
    x, y = column + atlas.shift[0].take(column), row + atlas.shift[1].take(column)
    limits = np.array([shape[1], shape[0], shape[1], shape[0]])
    right, bottom = limits[:2, None] // atlas.scale
    inside = (x >= 0) & (y >= 0) & (x < right.take(column)) & (y < bottom.take(column))
    x, y, weight = x + 0.5, y + 0.5, covered.share * inside
    terms = (weight, weight * x, weight * y, weight * x * x, weight * x * y, weight * y * y)  # eq. 1
    count = len(found.certainty) + 1
    sums = [np.bincount(owner, term, minlength=count)[1:] for term in terms]
    moments = np.stack(sums, axis=-1).astype(np.float64)
    moments[:, [3, 5]] += PIXEL_VARIANCE * moments[:, :1]
    first = found.box[:, 0]
    scale = atlas.scale[first] >> times
    moments = moments * scale[:, None] ** MOMENT_POWERS
    limits = limits >> times
    box = np.clip((found.box + np.tile(atlas.shift[:, first].T, 2)) * scale[:, None], 0, limits)
    clipped = (box[:, :2] <= 0).any(axis=1) | (box[:, 2:] > limits[2:] - scale[:, None]).any(axis=1)
    clipped |= found.cut
    image, color = atlas.image[first], atlas.color[first].astype(np.int64)
    order = np.lexsort((-moments[:, 0], color, image))
    order = order[moments[order, 0] >= FEWEST_PIXELS]
    alike = 256 * image[order] + color[order]
    order = order[np.arange(len(alike)) - np.searchsorted(alike, alike) < 8]  # bounds the memory of a clip
    every = Regions(color[order], moments[order], box[order], found.certainty[order], clipped[order])
    start = np.searchsorted(image[order], np.arange(images + 1)).tolist()
    return [every.part(a, b) for a, b in itertools.pairwise(start)]


CORNERS = 32


def ellipse_outline(centroid: ArrayLike, second_moment: ArrayLike) -> Array:
    """Closed outlines (..., K, 2) [px] of the uniform ellipses with given moments; NaN where those are."""
    center = np.asarray(centroid, dtype=np.float64)
    moments = np.asarray(second_moment, dtype=np.float64)
    known = np.isfinite(center).all(-1) & np.isfinite(moments).all((-1, -2))
    values, axes = np.linalg.eigh(np.where(known[..., None, None], moments, np.eye(2)))
    # The second moments of a uniform ellipse are a quarter of its squared half-axes.
    half_axes = 2.0 * np.sqrt(np.maximum(values, 0.0))
    angle = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    around = (circle * half_axes[..., None, :]) @ np.swapaxes(axes, -1, -2)
    return np.asarray(np.where(known[..., None, None], center[..., None, :] + around, np.nan))


def mask_outlines(mask: SingleArray, scale: float) -> list[Array]:
    """Closed outlines (N, 2) [px], `scale` to one of the mask, of what it covers half, the longest first."""
    fine = cv2.resize(mask, None, fx=2, fy=2, interpolation=cv2.INTER_LINEAR)
    inside = (np.asarray(fine) >= 0.5).view(np.uint8)
    found, _ = cv2.findContours(inside, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)
    # OpenCV follows the centers of the outermost points that are inside.
    outlines = [(contour[:, 0] + 0.5) * (scale / 2) for contour in found if len(contour) > 2]
    return sorted(outlines, key=len, reverse=True)
