"""One pass over a clip for all later steps, or none where a cached reading is still valid."""

from collections.abc import Generator, Sequence
from dataclasses import replace

import numpy as np

from ..errors import InputError
from .clips.album import Album
from .clips.clip import Clip
from .clips.frame_checks import FrameChecks
from .clips.watched_clip import watch_clip
from .ignored_regions import IgnoredRegion
from .marker_style import MarkerStyle
from .markers import assign_detections, detect_markers, still_valid
from .reading import Reading
from .reading_key import of_same_footage, reading_key
from .region_tracks import ExpectedRegions, RegionTracks


def read_clip(
    clip: Clip,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None = None,
    with_album: bool = True,
    kept: Reading | None = None,
    ignored: Sequence[IgnoredRegion] = (),
) -> Generator[float, None, Reading]:
    """Track the markers through a clip, check its frames and keep a small picture of each.

    Args:
        clip: The footage.
        styles: The markers.
        expected: Expected regions of the markers; optional.
        with_album: Whether pictures are kept.
        kept: A cached reading, of any clip. It is returned without decoding the clip if its key is the same;
            if only the expected regions differ and the colors would be learned alike, its detections are
            assigned to the markers anew.
        ignored: Regions of the picture that are never a marker.

    Yields:
        The fraction done, from 0 to 1.

    Returns:
        The reading, to the last digit the same as without a cached one.

    Raises:
        InputError: The clip shows nothing, a marker's color matches nothing, or a frame cannot be read.
    """
    yield 0.0
    key = reading_key(clip.path, clip.fps, styles, expected, ignored)
    if kept is not None and (kept.album is not None or not with_album):
        kept = kept if with_album else replace(kept, album=None)
        if kept.key == key:
            return kept
        seen = kept.detections
        same = seen is not None and of_same_footage(kept.key, key)
        if seen is not None and same and still_valid(seen, styles, expected, ignored):
            return replace(kept, tracks=assign_detections(seen, styles, expected), key=key)
    album, checks = Album() if with_album else None, FrameChecks()
    if not styles:
        tracks = yield from _watch(watch_clip(clip, checks, album))
        return Reading(tracks, album, key=key, frame_findings=checks.findings())
    try:
        seen = yield from detect_markers(watch_clip(clip, checks, album), styles, expected, ignored)
    except InputError as error:
        why = checks.nothing_seen()
        if why is not None:
            raise InputError(f"{clip.path}: {why}") from error
        if clip.notes:
            raise InputError("; ".join([str(error), *clip.notes])) from error
        raise
    yield 1.0
    return Reading(
        assign_detections(seen, styles, expected), album, seen, key=key, frame_findings=checks.findings()
    )


def _watch(clip: Clip) -> Generator[float, None, RegionTracks]:
    """Decode a clip in which no marker is followed, for its checks, pictures and times."""
    time_s: list[float] = []
    for _, stamp, _ in clip.frames():
        time_s.append(stamp)
        yield min(len(time_s) / clip.frame_count, 1.0)
    return RegionTracks.unmarked(np.array(time_s), clip.size)
