"""Warnings of a marker check: likely failures of a marker's color, as sentences."""

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from ..arrays import Array, BoolArray, Image
from ..video.clip import ClipSamples
from ..video.working_image import halvings, smooth
from .association import STILL_STEP_PX, Candidates
from .color_model import BACKGROUND, ColorModel
from .ignored_regions import IgnoredPixels, PixelBox, is_ignored

MUCH = 0.2  # share of confused pixels from which a warning is due
SMALL_PX = 40.0  # pixels of the measuring grid below which a region is hardly more than its border


class Likeness(NamedTuple):
    """Other things that look like a marker."""

    alike: Sequence[str]  # names of the markers of the same color
    claimed: Sequence[tuple[str, float]]
    """Names of the other colors' markers, each with the share of the marker's pixels classified as theirs."""
    background: float  # share of the marker's pixels classified as background
    clutter: float  # share of the area of its color that is no marker's
    rivals: float  # share of the area of its color's markers that is another marker's


def marker_warnings(
    name: str, found: int, sampled: int, grid_area: float, likeness: Likeness, still: Sequence[str] = ()
) -> tuple[str, ...]:
    """Warnings of a marker that was detected, the gravest first.

    `grid_area` is its median area in pixels of the measuring grid; `still` says where its color stays still.
    """
    sentences = alike_warnings(name, likeness.alike)
    sentences += [
        f"{name} and {other} have colors too alike: {100.0 * share:.0f} % of {name} would pass for {other}"
        for other, share in likeness.claimed
        if share >= MUCH
    ]
    if likeness.background >= MUCH:
        sentences.append(
            f"the background has the color of {name}: {100.0 * likeness.background:.0f} % of the "
            "marker would pass for background"
        )
    if likeness.clutter >= MUCH:
        sentences.append(
            f"{100.0 * likeness.clutter:.0f} % of the pixels with the color of {name} are something "
            "else in the picture"
        )
    if still:
        sentences.append(
            f"the color of {name} also stays still {' and '.join(still)} of the picture, which is "
            "surely no marker"
        )
    if sampled >= 6 and found < 0.6 * sampled:  # fewer may miss a marker by chance
        sentences.append(
            f"{name} is found in only {found} of {sampled} frames; if it is visible in one of the "
            "others, pick its color there"
        )
    if grid_area < SMALL_PX:
        sentences.append(
            f"{name} is small in the picture, so its position and direction are uncertain; film from nearer"
        )
    return tuple(sentences)


def alike_warnings(name: str, alike: Sequence[str]) -> list[str]:
    """A sentence on the markers of the same color as one, if there are any."""
    names = " and ".join(alike)
    sentence = f"{name} has almost the same color as {names}; only keyframes and paths tell them apart"
    return [sentence] if alike else []


NEARLY_ALWAYS = 0.9  # share of the samples in which a still pixel has the color; limbs pass before it
MARGIN = 2  # pixels of the measuring grid around a still area that lens and encoding blend its color into
SIDE = cv2.getStructuringElement(cv2.MORPH_RECT, (3, 3))
THIRDS = (
    ("top left", "top", "top right"),
    ("left", "middle", "right"),
    ("bottom left", "bottom", "bottom right"),
)


def still_areas(
    samples: ClipSamples,
    model: ColorModel,
    groups: Sequence[Sequence[int]],
    found: Sequence[Candidates],
    ignored: IgnoredPixels,
) -> dict[int, tuple[PixelBox, ...]]:
    """Boxes around the still areas of each marker's color, by its index, the largest's first, in px.

    None where it is not sure, or where several markers share a color: either may be the one at rest. `found`
    are the regions of each color in the samples.
    """
    boxes: dict[int, tuple[PixelBox, ...]] = {marker: () for group in groups for marker in group}
    count = len(samples.images)
    if count < 8:
        return boxes
    labels = np.stack([model.labels(smooth(image)) for image in samples.images])
    for index in range(count):
        mask = ignored.mask(index)
        if mask is not None:
            labels[index][is_ignored(mask)] = BACKGROUND
    for color, group in enumerate(groups):
        if len(group) == 1:
            share = np.mean(labels == color, axis=0)
            boxes[group[0]] = _boxes(share, found[color], samples.size)
    return boxes


def places(boxes: Sequence[PixelBox], size: tuple[int, int]) -> tuple[str, ...]:
    """Where in a picture of (width, height) boxes lie, each place once: `at the top left`."""
    found = []
    for left, top, right, bottom in boxes:
        column = min(int(1.5 * (left + right) / size[0]), 2)
        row = min(int(1.5 * (top + bottom) / size[1]), 2)
        found.append(f"{'in' if row == column == 1 else 'at'} the {THIRDS[row][column]}")
    return tuple(dict.fromkeys(found))


def _boxes(share: Array, found: Candidates, size: tuple[int, int]) -> tuple[PixelBox, ...]:
    """Boxes around the still areas that are no marker, in px of a clip of (width, height).

    `share` (rows, columns) is that of the sampled frames in which each pixel has the color.
    """
    scale, still = 1 << halvings(size), share >= NEARLY_ALWAYS
    grown = np.asarray(cv2.dilate(still.view(np.uint8), SIDE, iterations=MARGIN), dtype=np.uint8)
    least = 0.1 * _moving_area(grown, found, scale)  # less is not worth a word
    if not least:
        return ()
    count, number, stats, _ = cv2.connectedComponentsWithStats(grown, connectivity=8)
    covering: list[tuple[int, int, int, int]] = []
    for one in (1 + np.argsort(-stats[1:, cv2.CC_STAT_AREA], kind="stable")).tolist():
        area = still & (number == one)
        if np.count_nonzero(area) >= least and _rests(area, share):
            covering += _covering(np.equal(number, one).view(np.uint8), 0, 0)
    width, height = size
    return tuple(
        (float(a * scale), float(b * scale), float(min(c * scale, width)), float(min(d * scale, height)))
        for a, b, c, d in covering
    )


def _rests(area: BoolArray, share: Array) -> bool:
    """Whether the outline of a still area rests: few pixels about it have the color now and then."""
    mask = area.view(np.uint8)
    around = cv2.dilate(mask, SIDE, iterations=2 * MARGIN).view(np.bool_)
    now_and_then = around & (share >= 0.25) & (share < NEARLY_ALWAYS)  # by the marker that passes
    outline = np.count_nonzero(mask) - np.count_nonzero(cv2.erode(mask, SIDE))
    return bool(np.count_nonzero(now_and_then) <= 1.5 * outline)  # a second ring shows that it moves


def _moving_area(still: Image, found: Candidates, scale: int) -> float:
    """Usual area of what moves beside the still areas, in pixels of the measuring grid; 0 if it is not sure.

    `still` (rows, columns) is 1 in and around them, `scale` pixels of the clip to one of the grid.
    """
    place, area = found.centroid / scale, found.area / scale**2
    total = cv2.integral(still)
    left, top, right, bottom = np.round(found.box / scale).astype(int).T
    within = total[bottom, right] - total[top, right] - total[bottom, left] + total[top, left]
    beside = np.flatnonzero((within < 0.5 * area) & (area >= SMALL_PX))
    # A frame's regions begin with the largest.
    frames, first = np.unique(found.frame[beside], return_index=True)
    if len(frames) < 0.5 * (len(found.start) - 1):
        return 0.0
    largest = beside[first]
    usual = float(np.median(area[largest]))
    away = np.linalg.norm(place[largest] - np.median(place[largest], axis=0), axis=1)
    return usual if float(np.median(away)) >= (2.0 * STILL_STEP_PX) else 0.0


def _covering(mask: Image, left: int, top: int) -> list[tuple[int, int, int, int]]:
    """Few boxes (left, top, right, bottom) over a mask and little more; its corner is at (left, top)."""
    x, y, columns, rows = cv2.boundingRect(mask)
    if not columns:
        return []
    part = np.ascontiguousarray(mask[y : y + rows, x : x + columns])
    left, top = left + x, top + y
    filled = cv2.countNonZero(part) / part.size
    if filled >= 0.75 or max(columns, rows) <= 8:
        return [(left, top, left + columns, top + rows)]
    if columns >= rows:
        half = columns // 2
        return _covering(part[:, :half], left, top) + _covering(part[:, half:], left + half, top)
    half = rows // 2
    return _covering(part[:half], left, top) + _covering(part[half:], left, top + half)
