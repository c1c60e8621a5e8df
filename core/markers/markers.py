"""Tracking the colored markers of a clip: from one color sample each to tracks of their image regions."""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy

from ..arrays import Array, BoolArray, Image, IndexArray, IntArray
from ..errors import InputError
from ..numerics.markov_chain import cheapest_track
from ..video.clip import Clip, FrameReader
from ..video.working_image import halvings, measuring_image
from .color_learning import ColorLearner, color_groups
from .ignored_regions import IgnoredPixels, IgnoredRegion
from .moments import MOMENT_POWERS, centroid_and_second_moment
from .region_tracks import NO_REGIONS, Detections, ExpectedRegions, MarkerStyle, Regions, RegionTracks
from .regions import find_regions

HIGHEST_FRAGMENT_COST = 10.0  # highest cost of a region that counts as a fragment of a marker
RESTART_COST = 10.0
STILL_STEP_PX = 1.5


@dataclass(frozen=True, eq=False)
class Candidates:
    """The detected regions of one color over a clip, N in all."""

    frame: IntArray  # (N,) frame index of each region, ascending
    moments: Array  # (N, 6) raw moments
    box: Array  # (N, 4) left, top, right, bottom in px
    certainty: Array  # (N,) color certainty in 0..1
    clipped: BoolArray  # (N,) whether the region touches the image's border
    start: IndexArray  # (F + 1,) index of each frame's first region

    @property
    def centroid(self) -> Array:
        """Centroids, (N, 2) px."""
        return np.asarray(self.moments[:, 1:3] / self.moments[:, :1])

    @property
    def area(self) -> Array:
        """Areas, (N,) px."""
        return np.asarray(self.moments[:, 0])


def gather_candidates(regions: Sequence[Regions], color: int, scale: float) -> Candidates:
    """The regions of one color, in pixels of the image; `scale` are those to one of the measuring grid."""
    frame = np.repeat(np.arange(len(regions)), [len(found.color) for found in regions])
    own = np.concatenate([found.color for found in regions]) == color
    frame = frame[own]
    return Candidates(
        frame=frame,
        moments=np.concatenate([found.moments for found in regions])[own] * scale**MOMENT_POWERS,
        box=np.concatenate([found.box for found in regions])[own] * scale,
        certainty=np.concatenate([found.certainty for found in regions])[own],
        clipped=np.concatenate([found.clipped for found in regions])[own],
        start=np.searchsorted(frame, np.arange(len(regions) + 1)),
    )


def static_clutter(found: Candidates) -> BoolArray:
    """Mark static clutter (N,): regions that rest for most of the clip while others of their color move.

    A resting marker is not marked: no other region of its color is visible at the same time.
    """
    frames = len(found.start) - 1
    if not len(found.frame):
        return np.zeros(0, dtype=np.bool_)
    # Still are those with similar ones at the same position in most frames. Positions and sizes are counted
    # in cells; regions in the same or a neighboring cell, which reach one step on average, are similar.
    steps = np.array([STILL_STEP_PX, STILL_STEP_PX, 0.4]) * (2.0 / 3.0)
    cells = np.column_stack([found.centroid, np.log(found.area)]) / steps
    cells = np.floor(cells - cells.min(axis=0)).astype(np.int64) + 1
    sides = tuple(cells.max(axis=0) + 2)
    numbers = np.ravel_multi_index(tuple(cells.T), sides)
    cell, index, count = np.unique(numbers, return_inverse=True, return_counts=True)
    around = np.zeros(len(cell), dtype=np.int64)
    for offset in np.ndindex(3, 3, 3):
        neighbor = cell + np.ravel_multi_index(offset, sides) - np.ravel_multi_index((1, 1, 1), sides)
        where = np.minimum(np.searchsorted(cell, neighbor), len(cell) - 1)
        around += np.where(cell[where] == neighbor, count[where], 0)
    still = np.asarray(around[index] >= 0.5 * frames)
    if not still.any():
        return still
    rest = float(np.median(found.area[still]))
    with_still = np.zeros(frames, dtype=np.bool_)
    with_still[found.frame[still]] = True
    rival = ~still & with_still[found.frame] & (found.area >= 0.1 * rest)  # less is noise
    rivals = len(np.unique(found.frame[rival]))
    return still if rivals >= 0.25 * frames else np.zeros_like(still)


def viterbi_path(found: Candidates, unary: Array, size_px: float) -> IndexArray:
    """The Viterbi path: index of the marker's main region in each frame (F,), -1 where it is hidden.

    `unary` is the cost (N,) of each region as the marker, whose length in px measures its steps.
    """
    position = found.centroid / (0.35 * size_px)  # limbs move their own size in 0.1 s

    def step_costs(here: IndexArray, before: IndexArray) -> Array:
        gap = found.frame[here][:, None] - found.frame[before]
        squared = ((position[here][:, None] - position[before]) ** 2).sum(axis=-1) / gap**2
        # A visible marker is visible in the next frame in 98 of 100 cases; a swung arm takes several large
        # steps in a row, as Student's t has them.
        return np.asarray(np.where(gap > 1, 4.0, 0.0) + np.log1p(0.5 * squared))

    absent = np.full(len(found.start) - 1, 2.5)  # once hidden, a marker stays so for a while
    # The speed bounds a path over a dozen hidden frames.
    return cheapest_track(found.start, unary, absent, RESTART_COST, 12, step_costs)


def region_costs(
    found: Candidates,
    clutter: BoolArray,
    usual_area: float,
    expected: ExpectedRegions | None,
    marker: int,
    taken: BoolArray,
    rivals: Sequence[int],
) -> Array:
    """Unary cost (N,) of each region as the marker, by area [px], color, clutter, position and rivals.

    `taken` says (N,) whether a region is a rival's already; `rivals` are the other markers of its color.
    """
    if not len(found.frame):
        return np.zeros(0)
    # Foreshortening and occlusion change areas by a factor of three.
    cost = 0.5 * (np.log(found.area / usual_area) / 1.2) ** 2
    cost -= 3.0 * np.log(np.clip(found.certainty, 1e-3, 1.0))  # as many pixels err independently
    cost += np.where(clutter, 20.0, 0.0)
    own, most = _relative_offset(found, expected, marker), 20.0
    cost += np.nan_to_num(np.minimum(0.5 * (2.0 * own) ** 2, 2.0 * RESTART_COST))
    cost += np.where(taken, most, 0.0)
    for rival in rivals:
        nearer = own**2 - _relative_offset(found, expected, rival) ** 2
        # In units of the generous radius.
        cost += np.clip(np.nan_to_num(0.5 * nearer / 0.2**2), 0.0, most)
    return cost


def _relative_offset(found: Candidates, expected: ExpectedRegions | None, marker: int) -> Array:
    """Distance (N,) of each region from the marker's expected position, in radii; NaN where unknown."""
    relative = np.full(len(found.frame), np.nan)
    if expected is not None:
        # A container's claimed frame count may fall short: frames beyond it have no expectation.
        known = np.flatnonzero(found.frame < len(expected.center))
        frame = found.frame[known]
        offset = np.linalg.norm(found.centroid[known] - expected.center[frame, marker], axis=1)
        relative[known] = offset / np.maximum(expected.radius[frame, marker], 1.0)
    return relative


class MarkerRegion(NamedTuple):
    """A marker's joined region in each of F frames."""

    moments: Array  # (F, 6) raw moments, zero where hidden
    clipped: BoolArray  # (F,) whether it touches the image's border
    certainty: Array  # (F,) certainty of its color, in 0..1
    share: Array  # (F,) share of its main fragment in its area


def join_fragments(
    found: Candidates, path: IndexArray, cost: Array, reach_px: float, most_cost: float
) -> MarkerRegion:
    """Join each frame's main region with the fragments that an occluding limb cut off from it.

    `path` (F,) is the main region of each frame, -1 where hidden. Fragments lie within `reach_px` of it and
    cost (N,) no more than `most_cost`; others are clutter.
    """
    frames = len(path)
    main = path[found.frame]  # (N,) of each region, the main one of its frame
    left, top, right, bottom = found.box.T
    across = np.maximum(left[main] - right, left - right[main])
    down = np.maximum(top[main] - bottom, top - bottom[main])
    gap = np.where(main >= 0, np.hypot(np.maximum(across, 0.0), np.maximum(down, 0.0)), np.inf)
    taken = np.flatnonzero((main == np.arange(len(main))) | ((gap <= reach_px) & (cost <= most_cost)))
    frame = found.frame[taken]
    moments, clipped = np.zeros((frames, 6)), np.zeros(frames, dtype=np.bool_)
    np.add.at(moments, frame, found.moments[taken])
    np.logical_or.at(clipped, frame, found.clipped[taken])
    area = np.where(moments[:, 0] > 0.0, moments[:, 0], 1.0)
    certainty = np.bincount(frame, found.certainty[taken] * found.area[taken], minlength=frames) / area
    share = np.zeros(frames)
    seen = np.flatnonzero(path >= 0)
    share[seen] = found.area[path[seen]] / area[seen]
    return MarkerRegion(moments, clipped, certainty, share)


def region_quality(own: MarkerRegion) -> Array:
    """Quality of each region as the whole marker, (F,) in 0..1; 0 where hidden.

    The product of four factors: area relative to the full area in the frames around, clipping by the image's
    border, certainty of the color, and fragmentation.
    """
    area = own.moments[:, 0]
    if not np.any(area > 0.0):
        return np.zeros(len(area))
    seen = area > 0.0
    full = np.zeros(len(area))
    # Frames; a marker turns more slowly.
    full[seen] = scipy.ndimage.percentile_filter(
        area[seen], 80, size=min(31, int(seen.sum())), mode="nearest"
    )
    ratio = np.where(seen, area, 1.0) / np.where(seen, full, 1.0)
    whole = np.minimum(np.minimum(ratio, 1.5 / ratio), 1.0)
    quality = whole * own.certainty * (0.5 + 0.5 * own.share) * np.where(own.clipped, 0.4, 1.0)
    return np.where(seen, np.clip(quality, 0.0, 1.0), 0.0)


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
    usual = []
    for one, still in zip(found, clutter, strict=True):  # each frame's largest, without clutter
        largest = np.zeros(len(one.start) - 1)
        np.maximum.at(largest, one.frame, np.where(still, 0.0, one.area))
        usual.append(float(np.median(largest[largest > 0.0])) if np.any(largest > 0.0) else 0.0)
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
            rivals = [other for other in group if other != marker]
            cost = region_costs(one, clutter[color], usual[color], expected, marker, taken, rivals)
            path = choose(one, cost, length)
            own[marker] = join_fragments(one, path, cost, reach, HIGHEST_FRAGMENT_COST)
            taken[path[path >= 0]] = True
    return own


STRETCH_BYTES = 100_000_000  # images buffered until the colors are learned: five seconds of video


def detect_markers(
    clip: Clip,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None = None,
    ignored: Sequence[IgnoredRegion] = (),
) -> Generator[float, None, Detections]:
    """Detect all regions of the markers' colors in a clip, in one pass and constant memory.

    The clip's first images are buffered, reduced, until the colors are learned from them; later ones are
    segmented as they come, four together, which amortizes the overhead of each step. A color that matches
    nothing in the clip is refused. Yields the fraction done.
    """
    pixels = IgnoredPixels(tuple(ignored), clip.size)
    colors = ColorLearner(clip.path, clip.size, styles, expected, pixels)
    times, learned = halvings(clip.size), False
    longest = STRETCH_BYTES // (3 * (clip.size[0] >> times) * (clip.size[1] >> times))
    waiting: list[Image] = []
    regions: list[Regions] = []
    time_s: list[float] = []

    def segment(halved: int, least: int) -> Generator[float, None, None]:
        while len(waiting) >= least:
            batch, first = waiting[:4], len(regions)
            masks = [pixels.mask(first + number) for number in range(len(batch))] if ignored else []
            before = regions[-1] if regions else NO_REGIONS
            regions.extend(find_regions(batch, halved, colors.model, before, masks))
            del waiting[:4]
            yield min((len(time_s) + len(regions)) / (2.0 * clip.frame_count), 1.0)

    for index, stamp, image in clip.frames():
        if index == longest:
            colors.learn(waiting)
            learned = True
            yield from segment(0, 1)
        time_s.append(stamp)
        waiting.append(image if learned else measuring_image(image, times))
        if learned:
            colors.watch(index, image)
            yield from segment(times, 4)
        yield min((len(time_s) + len(regions)) / (2.0 * clip.frame_count), 1.0)
    if not learned:
        colors.learn(waiting)
    yield from segment(times if learned else 0, 1)
    colors.check_found()
    rounds = tuple(colors.learning_rounds)
    return Detections(tuple(regions), np.array(time_s), clip.size, rounds, colors.samples)


def assign_detections(
    seen: Detections, styles: Sequence[MarkerStyle], expected: ExpectedRegions | None = None
) -> RegionTracks:
    """Assign the detected regions to the markers over the whole clip at once."""
    groups, scale = color_groups(styles), 2.0 ** halvings(seen.size)
    found = [gather_candidates(seen.regions, color, scale) for color in range(len(groups))]
    joined = assign_regions(found, groups, expected, viterbi_path)
    rows = [joined[marker] for marker in range(len(styles))]
    moments = np.stack([row.moments for row in rows], axis=1)  # (F, M, 6)
    centroid, second = centroid_and_second_moment(moments)
    how = "only their paths tell which is which" if expected is None else "the keyframes tell which is which"
    alike = [" and ".join(styles[marker].name for marker in group) for group in groups if len(group) > 1]
    return RegionTracks(
        names=tuple(style.name for style in styles),
        centroid=centroid,
        second_moment=second,
        area=np.where(moments[..., 0] > 0.0, moments[..., 0], np.nan),
        quality=np.stack([region_quality(row) for row in rows], axis=1),
        clipped=np.stack([row.clipped for row in rows], axis=1),
        time_s=seen.time_s,
        size=seen.size,
        notes=tuple(f"markers {names} have almost the same color; {how}" for names in alike),
    )


def regions_of_frame(
    clip: Clip,
    time_s: float,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None = None,
    ignored: Sequence[IgnoredRegion] = (),
    index: int = 0,
) -> RegionTracks:
    """Detect the markers in one frame, by colors learned from frames spread over the clip.

    The frame is that at a time from the first; its index counts for regions that are ignored in some frames
    only. Expected regions are those of this frame, (1, M).
    """
    image = FrameReader(clip).image_at(time_s)
    if image is None:
        raise InputError(f"{clip.path}: there is no frame at {time_s:.2f} s; go to a frame of the footage")
    times = halvings(clip.size)
    samples = [(number, measuring_image(sample, times)) for number, sample in clip.sample(12)]
    pixels = IgnoredPixels(tuple(ignored), clip.size)
    of_samples = replace(pixels, sampled=tuple(number for number, _ in samples))
    colors = ColorLearner(clip.path, clip.size, styles, ignored=of_samples)
    colors.learn([sample for _, sample in samples])
    colors.check_found()
    regions = find_regions([image], times, colors.model, ignored=[pixels.mask(index)])
    return assign_detections(Detections(tuple(regions), np.zeros(1), clip.size, (), {}), styles, expected)
