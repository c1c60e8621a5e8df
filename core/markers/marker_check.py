"""Assignment of detected regions to markers, for tracking and for the marker check."""

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IntArray
from ..video.clip import ClipSamples
from ..video.working_image import halvings
from .association import (
    Candidates,
    MarkerRegion,
    gather_candidates,
    join_fragments,
    region_costs,
    rival_costs,
    static_clutter,
    typical_area,
)
from .color_learning import ColorLearner
from .color_model import ColorModel
from .ignored_regions import IgnoredPixels, IgnoredRegion, PixelBox
from .moments import centroid_and_second_moment
from .region_tracks import ExpectedRegions, MarkerStyle
from .regions import find_regions
from .still_areas import Likeness, alike_warnings, marker_warnings, places, still_areas
from .strong_colors import color_confusion

HIGHEST_FRAGMENT_COST = 10.0  # highest cost of a region that counts as a fragment of a marker


def assign_regions(
    found: Sequence[Candidates],
    groups: Sequence[Sequence[int]],
    expected: ExpectedRegions | None,
    choose: Callable[[Candidates, Array, float], IntArray],
) -> dict[int, MarkerRegion]:
    """Assign regions to markers in every frame; return each marker's by its index.

    `found` and `groups` are the regions and the markers of each color. `choose` gives, of a color's regions,
    their costs (N,) and the marker's length in px, the main region of each frame (F,), -1 where it is hidden.
    """
    alone = [len(group) == 1 for group in groups]
    clutter = [
        static_clutter(one) if single else np.zeros(len(one.frame), dtype=np.bool_)
        for one, single in zip(found, alone, strict=True)
    ]
    usual = [typical_area(one, still) for one, still in zip(found, clutter, strict=True)]
    reach = 0.5 * float(np.sqrt(max(usual, default=0.0)))  # about the width of a limb that covers a marker
    own = {}
    for color, group in enumerate(groups):
        one = found[color]
        full = ~clutter[color] & (one.area >= 0.7 * usual[color])
        length = 1.0  # of the marker in px: the long axis of regions of the usual size
        if full.any():
            _, second = centroid_and_second_moment(one.moments[full])
            length = float(np.median(np.sqrt(12.0 * np.linalg.eigvalsh(second)[:, 1])))
        taken = np.zeros(len(one.frame), dtype=np.bool_)
        for marker in group:
            cost = region_costs(one, clutter[color], usual[color], expected, marker)
            cost += rival_costs(one, taken, expected, marker, [other for other in group if other != marker])
            path = choose(one, cost, length)
            own[marker] = join_fragments(one, path, cost, reach, HIGHEST_FRAGMENT_COST)
            taken[path[path >= 0]] = True
    return own


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
    likenesses = _likenesses([style.name for style in styles], colors, found, areas)
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


def _likenesses(
    names: Sequence[str], colors: ColorLearner, found: Sequence[Candidates], areas: Sequence[Array]
) -> dict[int, Likeness]:
    """Likeness of each marker to other things, by its index, from its area in every frame."""
    claims = color_confusion(colors.model)
    together = [" and ".join(names[marker] for marker in group) for group in colors.groups]
    likenesses = {}
    for color, group in enumerate(colors.groups):
        colored = float(found[color].area.sum())
        theirs = sum(float(areas[marker].sum()) for marker in group)
        clutter = max(colored - theirs, 0.0) / max(colored, 1.0)
        claimed = [
            (other, float(share))
            for index, (other, share) in enumerate(zip(together, claims[color, :-1], strict=True))
            if index != color
        ]
        for marker in group:
            alike = [names[other] for other in group if other != marker]
            rivals = 1.0 - float(areas[marker].sum()) / max(theirs, 1.0)
            likenesses[marker] = Likeness(alike, claimed, float(claims[color, -1]), clutter, rivals)
    return likenesses


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
