"""Check of markers in sampled frames: how reliably and distinctly each is found, what else has its color."""

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np

from ..arrays import Array, BoolArray, Image, IntArray
from ..video.clip import ClipSamples
from ..video.working_image import halvings, smooth
from .color_learning import ColorLearner
from .color_model import BACKGROUND, ColorModel, color_confusion
from .ignored_regions import IgnoredPixels, IgnoredRegion, PixelBox, is_ignored
from .markers import HIGHEST_FRAGMENT_COST, STILL_STEP_PX, Candidates, assign_regions, gather_candidates
from .region_tracks import ExpectedRegions, MarkerStyle
from .regions import find_regions

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
    # Lens and encoding blend its color into two pixels around a still area.
    grown = np.asarray(cv2.dilate(still.view(np.uint8), SIDE, iterations=2), dtype=np.uint8)
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
    around = cv2.dilate(mask, SIDE, iterations=4).view(np.bool_)
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


@dataclass(frozen=True)
class MarkerReadout:
    """Result of the check for one marker, from N sampled frames."""

    name: str  # the marker's name
    found: int  # number of frames in which it is detected
    sampled: int  # number of sampled frames, N
    area_px: float  # median area where it is detected, in pixels of the clip; 0 if it never is
    area_share: float  # the same as a share of the picture
    distinctness: float
    """Probability in 0..1 that a pixel of the marker is classified as such, times the share of the pixels so
    classified that are the marker's; 0 if it is never detected."""
    warnings: tuple[str, ...]  # sentences that name the marker
    still_boxes: tuple[PixelBox, ...] = ()
    """Boxes around still areas of its color that are surely no marker, in pixels of the clip."""


@dataclass(frozen=True, eq=False)
class MarkerCheck:
    """Result of the check for M markers in C colors."""

    readouts: tuple[MarkerReadout, ...]  # one a marker
    model: ColorModel  # the learned color model, for previews
    groups: tuple[tuple[int, ...], ...]  # the markers of each color
    missing: Mapping[int, str]
    """For each marker whose color is nowhere, by index, a sentence that begins with its name; tracking
    refuses such a clip."""


def check_markers(
    samples: ClipSamples,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None = None,
    ignored: Sequence[IgnoredRegion] = (),
) -> Generator[float, None, MarkerCheck]:
    """Detect the markers in sampled frames as tracking does, but in each frame by itself.

    A missing color does not prevent the check of the others. `expected` is that of the whole clip. Yields the
    fraction done.
    """
    yield 0.0
    frames = len(samples.images)
    at_samples = None
    if expected is not None:  # frames beyond the last known one get what is expected in that
        rows = np.minimum(samples.indices, len(expected.center) - 1)
        at_samples = ExpectedRegions(expected.center[rows], expected.radius[rows])
    pixels = IgnoredPixels(tuple(ignored), samples.size, samples.indices)
    colors = ColorLearner(samples.path, samples.size, styles, at_samples, pixels)
    colors.learn(samples.images)
    yield 0.5
    regions = []
    for done, image in enumerate(samples.images):
        regions += find_regions([image], 0, colors.model, ignored=[pixels.mask(done)])
        yield 0.5 + 0.5 * done / frames
    scale = 2.0 ** halvings(samples.size)
    found = [gather_candidates(regions, color, scale) for color in range(len(colors.groups))]
    own = assign_regions(found, colors.groups, at_samples, _cheapest)
    areas = [own[marker].moments[:, 0] for marker in range(len(styles))]
    names, claims = [style.name for style in styles], color_confusion(colors.model)
    together = [" and ".join(names[marker] for marker in group) for group in colors.groups]
    likenesses = {}
    for color, group in enumerate(colors.groups):
        colored = float(found[color].area.sum())
        theirs = sum(float(areas[marker].sum()) for marker in group)
        clutter = max(colored - theirs, 0.0) / max(colored, 1.0)
        shares = list(zip(together, map(float, claims[color, :-1]), strict=True))
        claimed = [*shares[:color], *shares[color + 1 :]]
        for marker in group:
            alike = [names[other] for other in group if other != marker]
            rivals = 1.0 - float(areas[marker].sum()) / max(theirs, 1.0)
            likenesses[marker] = Likeness(alike, claimed, float(claims[color, -1]), clutter, rivals)
    complaints = colors.complaints()
    still = still_areas(samples, colors.model, colors.groups, found, pixels)
    readouts = [
        _readout(style.name, area, samples.size, likenesses[marker], complaints.get(marker), still[marker])
        for marker, (style, area) in enumerate(zip(styles, areas, strict=True))
    ]
    yield 1.0
    groups = tuple(tuple(group) for group in colors.groups)
    return MarkerCheck(tuple(readouts), colors.model, groups, complaints)


def _cheapest(found: Candidates, cost: Array, _length_px: float) -> IntArray:
    """Index of each frame's cheapest region (F,), -1 where none is cheap; samples have no Viterbi path."""
    path = np.full(len(found.start) - 1, -1, dtype=np.int64)
    for frame, (first, end) in enumerate(zip(found.start[:-1], found.start[1:], strict=True)):
        if first < end:
            best = first + int(np.argmin(cost[first:end]))
            path[frame] = best if cost[best] <= HIGHEST_FRAGMENT_COST else -1
    return path


def _readout(
    name: str,
    area: Array,
    size: tuple[int, int],
    likeness: Likeness,
    complaint: str | None,
    still: tuple[PixelBox, ...],
) -> MarkerReadout:
    """A marker's readout from its area (N,) in px, 0 where it is not detected."""
    sampled, found = len(area), int(np.count_nonzero(area))
    if complaint is not None or not found:
        sentence = complaint or (
            f"{name} is in none of the {sampled} sampled frames, or something larger has its color; "
            "pick the color anew, or wear another"
        )
        warnings = (*alike_warnings(name, likeness.alike), sentence)
        return MarkerReadout(name, 0, sampled, 0.0, 0.0, 0.0, warnings)
    typical = float(np.median(area[area > 0.0]))
    own = 1.0 - likeness.background - sum(share for _, share in likeness.claimed)
    grid_area = typical / 4.0 ** halvings(size)
    return MarkerReadout(
        name=name,
        found=found,
        sampled=sampled,
        area_px=typical,
        area_share=typical / (size[0] * size[1]),
        distinctness=max(own, 0.0) * (1.0 - likeness.clutter) * (1.0 - likeness.rivals),
        warnings=marker_warnings(name, found, sampled, grid_area, likeness, places(still, size)),
        still_boxes=still,
    )
