"""Clip samples: frames spread over a clip, kept as small pictures, for repeated checks of the colors."""

from collections.abc import Generator
from dataclasses import dataclass
from pathlib import Path

from ...arrays import Image
from ...errors import InputError
from ..segmentation.working_image import halvings, measuring_image
from .clip import Clip

SAMPLED_FRAMES = 24
"""Twice as many as colors are learned from, so that most frames are checked with colors learned elsewhere."""


@dataclass(frozen=True, eq=False)
class ClipSamples:
    """N sampled frames of a clip."""

    path: Path
    """The clip, for messages."""
    size: tuple[int, int]
    """Width and height of its frames in px."""
    indices: tuple[int, ...]
    """(N,) their frame indices."""
    images: tuple[Image, ...]
    """Their pictures, (rows, columns, 3) uint8 blue, green, red on the measuring grid."""


def sample_clip(clip: Clip, count: int = SAMPLED_FRAMES) -> Generator[float, None, ClipSamples]:
    """Sample frames evenly over a clip.

    Args:
        clip: The footage.
        count: Number of samples; fewer for a shorter clip.

    Yields:
        The fraction done, from 0 to 1.

    Raises:
        InputError: None of them can be read.
    """
    times = halvings(clip.size)
    indices: list[int] = []
    images: list[Image] = []
    yield 0.0
    for index, image in clip.sample(count):
        indices.append(index)
        images.append(measuring_image(image, times))
        yield min(len(indices) / min(count, clip.frame_count), 1.0)
    if not images:
        raise InputError(f"{clip.path}: none of the sampled frames can be read; the file is damaged")
    return ClipSamples(clip.path, clip.size, tuple(indices), tuple(images))
