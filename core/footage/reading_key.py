"""Cache key of a reading: a digest of the clip, the markers, their expected regions and what is ignored."""

from collections.abc import Sequence
from pathlib import Path

from ..errors import InputError
from ..files.digest import digest, file_fingerprint
from .clips.image_sequence import find_images
from .ignored_regions import IgnoredRegion
from .marker_style import MarkerStyle
from .region_tracks import ExpectedRegions

FORMAT = 2
"""Version of the reading's algorithm and arrays; raised whenever either changes."""
MOST_SAMPLED = 24
"""Images of a longer sequence whose content is hashed, evenly spread."""
PREFIX = "reading"


def reading_key(
    path: Path,
    fps: float,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None,
    ignored: Sequence[IgnoredRegion] = (),
) -> str:
    """Cache key that changes with everything a reading depends on.

    Args:
        path: The clip, as `Clip.open` takes it.
        fps: Frames per second of an image sequence.
        styles: The markers.
        expected: Their expected regions.
        ignored: Regions of the picture that are never a marker.

    Raises:
        InputError: The clip is missing or cannot be read.
    """
    try:
        footage = _footage(path, fps)
    except OSError as error:
        raise InputError(f"{path}: the clip cannot be read ({error.strerror})") from error
    wanted = tuple((style.name, style.segment, tuple(style.color_srgb)) for style in styles)
    regions = None if expected is None else (expected.center, expected.radius)
    left_out = [(one.box, one.stroke, one.radius_px, one.frames) for one in ignored] if wanted else []
    return f"{PREFIX}-{digest(FORMAT, footage, wanted, *left_out)}-{digest(regions)}"


def of_same_footage(key: str, other: str) -> bool:
    """Whether two keys differ at most in the markers' expected regions."""
    return bool(key) and key.rpartition("-")[0] == other.rpartition("-")[0]


def footage_digest(path: Path) -> str:
    """Digest of a clip's file, or of the images of a sequence, independent of their folder.

    Args:
        path: The clip, as `Clip.open` takes it.

    Raises:
        InputError: The clip is missing or cannot be read.
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
