"""Times of a clip's frames: decoded once a session, however many jobs ask for them."""

from collections.abc import Generator, Sequence

import numpy as np

from ..arrays import Array
from .clips.clip import Clip
from .ignored_regions import IgnoredRegion
from .marker_style import MarkerStyle
from .reading import Reading
from .reading_key import footage_digest, of_same_footage, reading_key

MOST_CLIPS = 8
"""Clips whose times are remembered: those of the takes at hand."""
_known: dict[tuple[str, float], Array] = {}


def clip_times(
    clip: Clip,
    kept: Reading | None = None,
    styles: Sequence[MarkerStyle] = (),
    ignored: Sequence[IgnoredRegion] = (),
) -> Generator[float, None, Array]:
    """Find the time of every frame of a clip, by a pass over it unless its file is known and unchanged.

    Args:
        clip: The clip.
        kept: A cached reading of any clip; it knows the times where it is one of this clip, ...
        styles: ... with these markers ...
        ignored: ... and these regions that are never one.

    Yields:
        The fraction done, from 0 to 1.

    Returns:
        (F,) times [s].

    Raises:
        InputError: The clip is missing or cannot be read.
    """
    key = footage_digest(clip.path), clip.fps
    if key not in _known and kept is not None:
        own = reading_key(clip.path, clip.fps, styles, None, ignored)
        if of_same_footage(kept.key, own):
            _remember(key, kept.tracks.time_s)
    if key not in _known:
        stamps: list[float] = []
        for stamp in clip.source.time_stamps():
            stamps.append(stamp)
            yield min(len(stamps) / clip.frame_count, 1.0)
        _remember(key, np.array(stamps, dtype=np.float64))
    return _known[key]


def _remember(key: tuple[str, float], time_s: Array) -> None:
    _known[key] = time_s.copy()
    _known[key].setflags(write=False)
    for oldest in list(_known)[:-MOST_CLIPS]:
        del _known[oldest]
