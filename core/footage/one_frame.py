"""The markers' regions in a single frame, where the clip as a whole has not been gone through."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..errors import InputError
from .clip import Clip
from .clip_colours import ClipColours
from .clip_samples import sample_clip
from .colour_model import ColourModel
from .marker_style import MarkerStyle, colour_groups
from .markers import tracks_of_regions
from .regions import find_regions
from .tracks import ExpectedRegions, RegionTracks
from .working_image import halvings


def regions_of_frame(
    clip: Clip,
    index: int,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None = None,
    model: ColourModel | None = None,
) -> RegionTracks:
    """Find the markers in one frame.

    Args:
        clip: the footage.
        index: which frame, from 0.
        styles: the markers, M of them, in the order of the result.
        expected: where each is expected in this frame, (1, M); it tells a marker from clutter of its colour.
        model: the markers' colours; learned from frames spread over the clip by default.

    Returns:
        Tracks of one frame.

    Raises:
        InputError: a marker's colour matches nothing in the clip, or there is no such frame.
    """
    image = next((image for _, image in clip.source.at([index])), None)
    if image is None:
        raise InputError(f"{clip.path}: frame {index} cannot be read; the clip has {clip.frame_count} frames")
    model = model or _learned(clip, styles)
    regions = find_regions([image], halvings(clip.size), model)
    return tracks_of_regions(regions, styles, colour_groups(styles), expected, np.zeros(1), clip.size)


def _learned(clip: Clip, styles: Sequence[MarkerStyle]) -> ColourModel:
    """Learn the markers' colours from frames spread over a clip."""
    looking = sample_clip(clip)
    while True:
        try:
            next(looking)
        except StopIteration as stop:
            samples = stop.value
            break
    colours = ClipColours(clip.path, clip.size, styles)
    colours.learn(samples.images)
    colours.check_found()
    return colours.model
