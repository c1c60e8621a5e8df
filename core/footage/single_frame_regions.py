"""The markers' regions in a single frame, without a pass over the clip."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..errors import InputError
from .clips.clip import Clip
from .clips.frame_reader import FrameReader
from .colors.streaming_color_learning import StreamingColorLearner
from .detections import Detections
from .ignored_regions import IgnoredPixels, IgnoredRegion
from .marker_style import MarkerStyle
from .markers import assign_detections
from .region_tracks import ExpectedRegions, RegionTracks
from .segmentation.regions import find_regions
from .segmentation.working_image import halvings, measuring_image

SAMPLED_FRAMES = 12


def regions_of_frame(
    clip: Clip,
    time_s: float,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None = None,
    ignored: Sequence[IgnoredRegion] = (),
    index: int = 0,
) -> RegionTracks:
    """Detect the markers in one frame, by colors learned from frames spread over the clip.

    Args:
        clip: The footage.
        time_s: Time of the frame in seconds from the first.
        styles: The markers, M of them, in the order of the result.
        expected: Expected regions in this frame, (1, M), which tell markers from clutter of their colors.
        ignored: Regions of the picture that are never a marker.
        index: Index of the frame, for regions that are ignored in some frames only.

    Returns:
        Tracks of one frame.

    Raises:
        InputError: A marker's color matches nothing in the clip, or there is no such frame.
    """
    image = FrameReader(clip).image_at(time_s)
    if image is None:
        raise InputError(f"{clip.path}: there is no frame at {time_s:.2f} s; go to a frame of the footage")
    times = halvings(clip.size)
    samples = [(number, measuring_image(sample, times)) for number, sample in clip.sample(SAMPLED_FRAMES)]
    pixels = IgnoredPixels(tuple(ignored), clip.size)
    of_samples = replace(pixels, sampled=tuple(number for number, _ in samples))
    colors = StreamingColorLearner(clip.path, clip.size, styles, ignored=of_samples)
    colors.learn([sample for _, sample in samples])
    colors.check_found()
    regions = find_regions([image], times, colors.model, ignored=[pixels.mask(index)])
    return assign_detections(Detections(tuple(regions), np.zeros(1), clip.size, (), {}), styles, expected)
