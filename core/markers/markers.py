"""Tracking the colored markers of a clip: from one color sample each to tracks of their image regions."""

from collections.abc import Generator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..arrays import Array, Image
from ..errors import InputError
from ..video.clip import Clip, FrameReader
from ..video.working_image import halvings, measuring_image
from .association import gather_candidates, region_quality, viterbi_path
from .color_learning import ColorLearner, color_groups
from .ignored_regions import IgnoredPixels, IgnoredRegion
from .marker_check import assign_regions
from .moments import centroid_and_second_moment
from .region_tracks import NO_REGIONS, Detections, ExpectedRegions, MarkerStyle, Regions, RegionTracks
from .regions import find_regions

STRETCH_BYTES = 100_000_000  # images buffered until the colors are learned: five seconds of video
BATCH_SIZE = 4  # images segmented together: enough to amortize the overhead of each step


def track_markers(
    clip: Clip,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None = None,
    ignored: Sequence[IgnoredRegion] = (),
) -> Generator[float, None, RegionTracks]:
    """Track the markers through a clip; yields the fraction done.

    One pass over the clip in constant memory detects the regions of each marker's color; they are then
    assigned to the markers, apart from clutter of like hue, over the whole clip at once.

    Raises:
        InputError: A marker's color matches nothing in the clip, or a frame cannot be read.
    """
    yield 0.0
    seen = yield from detect_markers(clip, styles, expected, ignored)
    yield 1.0
    return assign_detections(seen, styles, expected)


def detect_markers(
    clip: Clip,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None = None,
    ignored: Sequence[IgnoredRegion] = (),
) -> Generator[float, None, Detections]:
    """Detect all regions of the markers' colors in a clip, in one pass; see `track_markers`."""
    pixels = IgnoredPixels(tuple(ignored), clip.size)
    colors = ColorLearner(clip.path, clip.size, styles, expected, pixels)
    regions, time_s = yield from _detect_regions(clip, colors, pixels)
    colors.check_found()
    return Detections(tuple(regions), time_s, clip.size, tuple(colors.learning_rounds), colors.samples)


def still_valid(
    seen: Detections,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None,
    ignored: Sequence[IgnoredRegion] = (),
) -> bool:
    """Whether other expected regions would give exactly the same detections."""
    pixels = IgnoredPixels(tuple(ignored), seen.size)
    return ColorLearner(Path(), seen.size, styles, expected, pixels).learn_again(seen)


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


def _detect_regions(
    clip: Clip, colors: ColorLearner, ignored: IgnoredPixels
) -> Generator[float, None, tuple[list[Regions], Array]]:
    """Detect the regions of every frame; return them and the frames' times.

    The clip's first images are buffered, reduced, until the colors are learned from them; later ones are
    segmented as they come.
    """
    times = halvings(clip.size)
    longest = STRETCH_BYTES // (3 * (clip.size[0] >> times) * (clip.size[1] >> times))
    waiting: list[Image] = []
    regions: list[Regions] = []
    time_s: list[float] = []
    for index, stamp, image in clip.frames():
        time_s.append(stamp)
        if index < longest:
            waiting.append(measuring_image(image, times))
        else:
            if index == longest:
                yield from _regions_of_stretch(waiting, colors, ignored, regions, clip.frame_count)
            waiting.append(image)
            colors.watch(index, image)
            if len(waiting) == BATCH_SIZE:
                masks = _masks(ignored, len(regions), len(waiting))
                regions += find_regions(waiting, times, colors.model, regions[-1], masks)
                waiting.clear()
        yield min((len(time_s) + len(regions)) / (2.0 * clip.frame_count), 1.0)
    if len(time_s) <= longest:
        yield from _regions_of_stretch(waiting, colors, ignored, regions, clip.frame_count)
    elif waiting:
        masks = _masks(ignored, len(regions), len(waiting))
        regions += find_regions(waiting, times, colors.model, regions[-1], masks)
    return regions, np.array(time_s)


def _regions_of_stretch(
    waiting: list[Image],
    colors: ColorLearner,
    ignored: IgnoredPixels,
    regions: list[Regions],
    frame_count: int,
) -> Generator[float, None, None]:
    """Learn the colors from buffered images on the measuring grid; append their regions, empty the buffer."""
    colors.learn(waiting)
    stretch = len(waiting)
    while waiting:
        before = regions[-1] if regions else NO_REGIONS
        batch = waiting[:BATCH_SIZE]
        regions += find_regions(batch, 0, colors.model, before, _masks(ignored, len(regions), len(batch)))
        del waiting[:BATCH_SIZE]
        yield min((stretch + len(regions)) / (2.0 * frame_count), 1.0)


def _masks(ignored: IgnoredPixels, first: int, count: int) -> list[Image | None]:
    """Masks of the ignored pixels of some successive frames; empty where none are ignored anywhere."""
    return [ignored.mask(first + number) for number in range(count)] if ignored.regions else []


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

    Raises:
        InputError: A marker's color matches nothing in the clip, or there is no such frame.
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
