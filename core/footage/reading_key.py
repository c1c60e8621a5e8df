"""By what a reading is known again: the clip, the markers looked for, and where they were expected."""

from collections.abc import Sequence
from pathlib import Path

from ..errors import InputError
from ..files.digest import digest, file_fingerprint
from .clips.image_sequence import find_images
from .marker_style import MarkerStyle
from .region_tracks import ExpectedRegions

FORMAT = 2
"""Raised whenever a clip is read in another way, or kept in another form."""
MOST_SAMPLED = 24
"""Of a folder of more images, this many, evenly spread, are looked into."""
PREFIX = "reading"


def reading_key(
    path: Path,
    fps: float,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None,
) -> str:
    """Return a key that changes with everything a reading depends on.

    Args:
        path: the clip, as `Clip.open` takes it.
        fps: frames per second of an image sequence.
        styles: the markers.
        expected: where they are looked for first.

    Raises:
        InputError: the clip is not there or cannot be read.
    """
    try:
        footage = _footage(path, fps)
    except OSError as error:
        raise InputError(f"{path}: the clip cannot be read ({error.strerror})") from error
    wanted = tuple((style.name, style.segment, tuple(style.color_srgb)) for style in styles)
    places = None if expected is None else (expected.center, expected.radius)
    return f"{PREFIX}-{digest(FORMAT, footage, wanted)}-{digest(places)}"


def of_same_footage(key: str, other: str) -> bool:
    """Tell whether two keys differ only in where the markers were expected."""
    return bool(key) and key.rpartition("-")[0] == other.rpartition("-")[0]


def footage_digest(path: Path) -> str:
    """Return a digest that changes with a clip's file, or any image of a sequence, wherever it lies.

    Args:
        path: the clip, as `Clip.open` takes it.

    Raises:
        InputError: the clip is not there or cannot be read.
    """
    try:
        return digest(*_footage(path, 0.0))
    except OSError as error:
        raise InputError(f"{path}: the clip cannot be read ({error.strerror})") from error


def _footage(path: Path, fps: float) -> tuple[object, ...]:
    images = find_images(path)
    if images is None:
        return (file_fingerprint(path),)
    states = [file.stat() for file in images]
    names = tuple((file.name, one.st_size, one.st_mtime_ns) for file, one in zip(images, states, strict=True))
    step = max(1, len(images) // MOST_SAMPLED)
    return fps, names, tuple(file_fingerprint(file) for file in images[::step])
