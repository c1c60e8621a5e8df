"""Sampling spread frames on a budget: the longer and larger a clip, the fewer frames are decoded."""

from collections.abc import Generator, Iterator

import numpy as np

from ...arrays import Image
from ...errors import InputError
from ..segmentation.working_image import halvings, measuring_image
from .clip import Clip
from .clip_samples import SAMPLED_FRAMES, ClipSamples, sample_clip
from .packets import quickly_found
from .video_file import VideoFile

MOST_DECODED_PX = 90_000_000
"""Budget of decoded pixels: about half a second of a processor, at any size."""
FRAMES_PER_SEARCH = 18
"""Frames decoded for each seek."""
MOST_SEARCHES = 12
IMAGE_COST = 4
"""Cost of opening an image, in decoded video frames."""
FEWEST = 3


def sample_spread_frames(clip: Clip, count: int = SAMPLED_FRAMES) -> Generator[float, None, ClipSamples]:
    """Sample frames evenly over a clip like `sample_clip`, within a budget of decoded pixels.

    Args:
        clip: The footage.
        count: Most samples.

    Yields:
        The fraction done, from 0 to 1.

    Raises:
        InputError: None of them can be read.
    """
    pixels = clip.size[0] * clip.size[1]
    if not isinstance(clip.source, VideoFile):
        affordable = max(MOST_DECODED_PX // (IMAGE_COST * pixels), FEWEST)
        return (yield from sample_clip(clip, min(count, affordable)))
    if clip.frame_count * pixels <= MOST_DECODED_PX:
        return (yield from sample_clip(clip, count))
    most = min(count, MOST_SEARCHES, max(MOST_DECODED_PX // (FRAMES_PER_SEARCH * pixels), FEWEST))
    middles = (np.arange(most) + 0.5) * clip.frame_count / most
    indices = quickly_found(clip.path, [int(index) for index in middles])
    if indices:
        return (yield from _kept(clip, clip.source.sought([0, *indices]), len(indices) + 1))
    # In files that cannot be seeked, only the beginning is affordable.
    first = range(0, min(clip.frame_count, MOST_DECODED_PX // pixels + 1), FRAMES_PER_SEARCH)
    return (yield from _kept(clip, clip.source.at(first), len(first)))


def _kept(clip: Clip, frames: Iterator[tuple[int, Image]], count: int) -> Generator[float, None, ClipSamples]:
    times = halvings(clip.size)
    found = []
    yield 0.0
    for index, image in frames:
        found.append((index, measuring_image(image, times)))
        yield min(len(found) / count, 1.0)
    if not found:
        raise InputError(f"{clip.path}: none of the sampled frames can be read; the file is damaged")
    return ClipSamples(clip.path, clip.size, tuple(i for i, _ in found), tuple(image for _, image in found))
