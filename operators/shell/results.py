"""A take's results, cached in memory and on disk."""

from collections import OrderedDict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import bpy
from bpy.types import PropertyGroup

from ...core.arrays import Array
from ...core.errors import ConversionError
from ...core.files.digest import ArrayCache, Arrays, digest

if TYPE_CHECKING:
    from ...core.markers.reading import Reading
    from ...core.review.review import Review


Result = TypeVar("Result")


class LruCache(OrderedDict[str, Result | None]):
    """Results by key; when it is full, the least recently used one is dropped. None: known to be absent."""

    def __init__(self, size: int = 6) -> None:
        super().__init__()
        self._size = size

    def known(self, key: str, load: Callable[[], Result | None]) -> Result | None:
        """The result of a key; the first time, what `load` returns."""
        self[key] = self[key] if key in self else load()
        return self[key]

    def __setitem__(self, key: str, result: Result | None) -> None:
        super().__setitem__(key, result)
        self.move_to_end(key)
        while len(self) > self._size:
            self.popitem(last=False)


@dataclass(frozen=True, eq=False)
class FootageSpeed:
    """V_sum of a take's footage over scene frames."""

    key: str  # digest of it
    frames: Array  # (F,) scene frames
    values: Array  # (F,) [px per frame]


EXTENSION = (__package__ or "").partition(".operators")[0]
"""Name under which Blender knows Keymark, and gives it a folder of its own."""

_readings: "LruCache[Reading]" = LruCache()
_reviews: "LruCache[Review]" = LruCache()
_speeds: LruCache[FootageSpeed] = LruCache()  # by the take's identifier and the key of its reading


MADE: LruCache[object] = LruCache(12)
"""Results of sessions' stages by the digest of all that they depend on."""


def reading_of(take: PropertyGroup) -> "Reading | None":
    """The last reading of a take's clip, for display: only `read_footage` checks it; None if it was lost."""
    from ...core.markers.reading import reading_from_arrays  # late: registering must not need OpenCV

    return _load(_readings, take.reading_key, reading_from_arrays)


def keep_reading(take: PropertyGroup, reading: "Reading") -> None:
    """Keep the reading of a take's clip, in memory and on disk."""
    from ...core.markers.reading import reading_arrays

    known = take.reading_key == reading.key and reading_of(take) is not None
    _readings[reading.key] = reading
    take.reading_key = reading.key
    if not known:
        _save(reading.key, reading_arrays(reading))


def review_of(take: PropertyGroup) -> "Review | None":
    """The review of a take's motion; None if there is none, or it was lost."""
    if not take.review_key:
        return None
    from ...core.review.review import Review

    return _load(_reviews, take.review_key, Review.from_arrays)


def keep_review(take: PropertyGroup, review: "Review") -> None:
    """Keep the review of a take's motion, in memory and on disk."""
    arrays = review.to_arrays()
    key = f"review-{digest(*(part for name in sorted(arrays) for part in (name, arrays[name])))}"
    _reviews[key] = review
    take.review_key = key
    _save(key, arrays)


def clear_review(take: PropertyGroup) -> None:
    """Reset the properties that show the review of a motion, which is gone."""
    shown = take.review
    for name in ("frame_count", "confidence", "unseen", "weak_frames", "active_weak_frame"):
        shown.property_unset(name)


def speed_of(take: PropertyGroup) -> FootageSpeed | None:
    """The speed by which keyframes were last proposed in this session, of the take's reading."""
    return _speeds.get(f"{take.identifier} {take.reading_key}")


def keep_speed(take: PropertyGroup, frames: Array, values: Array) -> None:
    """Keep in memory the speed in a take's footage, (F,) [px per frame] at scene frames (F,)."""
    speed = FootageSpeed(f"speed-{digest(frames, values)}", frames, values)
    _speeds[f"{take.identifier} {take.reading_key}"] = speed


def clear_cache() -> None:
    """Drop all results from memory; those on disk stay."""
    for cache in (_readings, _reviews, _speeds, MADE):
        cache.clear()


def _load(cache: LruCache[Result], key: str, from_arrays: Callable[[Arrays], Result]) -> Result | None:
    if not key:
        return None

    def stored() -> Result | None:
        arrays = _store().load(key)
        with suppress(KeyError, ValueError, TypeError, IndexError):  # of another version or program
            return None if arrays is None else from_arrays(arrays)
        return None

    return cache.known(key, stored)


def _save(key: str, arrays: Arrays) -> None:
    # A result that cannot be saved is computed again: no reason to fail.
    with suppress(ConversionError):
        _store().save(key, arrays)


def _store() -> ArrayCache:
    try:
        folder = Path(bpy.utils.extension_path_user(EXTENSION, path="results"))
    except ValueError:  # not installed as an extension
        folder = Path(bpy.app.tempdir) / "results"
    return ArrayCache(folder)


unregister = clear_cache
