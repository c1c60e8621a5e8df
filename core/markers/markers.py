"""Tracking the colored markers of a clip: from one color sample each to tracks of their image regions."""

from collections.abc import Generator, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Image
from ..errors import InputError
from ..video.clip import Clip, FrameReader
from ..video.working_image import halvings, measuring_image
from .association import assign_regions, gather_candidates, region_quality, viterbi_path
from .color_learning import ColorLearner, color_groups
from .ignored_regions import IgnoredPixels, IgnoredRegion
from .moments import centroid_and_second_moment
from .region_tracks import NO_REGIONS, Detections, ExpectedRegions, MarkerStyle, Regions, RegionTracks
from .regions import find_regions

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
