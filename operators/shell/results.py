"""What was computed of a take and is dear to compute again: found by the key that the take holds.

A key says what the result was computed from, and goes back with undo. Results are looked for in memory
first, then in the user's own folder; what is nowhere is remembered as absent, so that drawing never reaches
for the disk twice.
"""

from collections import OrderedDict
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

import bpy

from ...core.errors import ConversionError
from ...core.files.array_cache import ArrayCache
from ...core.files.digest import digest

if TYPE_CHECKING:
    from ...core.estimate.reconstruct import Reconstruction
    from ...core.files.array_cache import Arrays
    from ...core.footage.reading import Reading
    from ...core.review.review import Review

Result = TypeVar("Result")

MOST_REMEMBERED = 6
"""Results of each kind in memory: those of the takes at hand."""
FOLDER = "results"
EXTENSION = (__package__ or "").partition(".operators")[0]
"""By what Blender knows Keymark, and gives it a folder of its own."""


class Remembered(Generic[Result]):
    """The results last used, by key; None stands for one that is known to be nowhere."""

    def __init__(self, most: int = MOST_REMEMBERED) -> None:
        """Nothing yet."""
        self._most = most
        self._results: OrderedDict[str, Result | None] = OrderedDict()

    def get(self, key: str, otherwise: Callable[[], Result | None]) -> Result | None:
        """The result under a key; the first time, what `otherwise` finds."""
        if key not in self._results:
            self.put(key, otherwise())
        self._results.move_to_end(key)
        return self._results[key]

    def put(self, key: str, result: Result | None) -> None:
        """Remember a result, and forget the one that was not used for longest."""
        self._results[key] = result
        self._results.move_to_end(key)
        while len(self._results) > self._most:
            self._results.popitem(last=False)

    def clear(self) -> None:
        """Forget all."""
        self._results.clear()


_readings: "Remembered[Reading]" = Remembered()
_reviews: "Remembered[Review]" = Remembered()
_solved: "Remembered[Reconstruction]" = Remembered(2)
"""The last reconstruction of a take, by the take's identifier: the next one starts from there."""


def reading_of(take: bpy.types.PropertyGroup) -> "Reading | None":
    """What was last read of a take's clip; None where nothing was, or it was lost.

    It is for showing: whether it still holds is `read_footage` to say.
    """
    from ...core.footage.reading_arrays import reading_from_arrays

    return _kept(_readings, take.reading_key, reading_from_arrays)


def keep_reading(take: bpy.types.PropertyGroup, reading: "Reading") -> None:
    """Keep what was read of a take's clip."""
    from ...core.footage.reading_arrays import reading_arrays

    known = take.reading_key == reading.key and reading_of(take) is not None
    _readings.put(reading.key, reading)
    take.reading_key = reading.key
    if not known:
        _save(reading.key, reading_arrays(reading))


def review_of(take: bpy.types.PropertyGroup) -> "Review | None":
    """What is known of a take's motion; None where there is none, or it was lost."""
    if not take.review_key:
        return None
    from ...core.review.review import Review

    return _kept(_reviews, take.review_key, Review.from_arrays)


def keep_review(take: bpy.types.PropertyGroup, review: "Review") -> None:
    """Keep what is known of a take's motion."""
    arrays = review.to_arrays()
    key = f"review-{digest(*(part for name in sorted(arrays) for part in (name, arrays[name])))}"
    _reviews.put(key, review)
    take.review_key = key
    _save(key, arrays)


def clear_review(take: bpy.types.PropertyGroup) -> None:
    """Take back what was told of a motion that is there no more."""
    shown = take.review
    for name in ("frame_count", "confidence", "weak_frames", "active_weak_frame"):
        shown.property_unset(name)


def solved_before(take: bpy.types.PropertyGroup) -> "Reconstruction | None":
    """The take's last reconstruction in this session, for the next to start from."""
    return _solved.get(take.identifier, lambda: None)


def keep_solved(take: bpy.types.PropertyGroup, reconstruction: "Reconstruction") -> None:
    """Keep a reconstruction in memory for the take's next."""
    _solved.put(take.identifier, reconstruction)


def forget() -> None:
    """Let go of all that is held in memory; files stay."""
    for remembered in (_readings, _reviews, _solved):
        remembered.clear()


def _kept(
    remembered: Remembered[Result], key: str, from_arrays: "Callable[[Arrays], Result]"
) -> Result | None:
    if not key:
        return None

    def stored() -> Result | None:
        arrays = _store().load(key)
        with suppress(KeyError, ValueError, TypeError, IndexError):  # of another version, or somebody else's
            return None if arrays is None else from_arrays(arrays)
        return None

    return remembered.get(key, stored)


def _save(key: str, arrays: "Arrays") -> None:
    # What cannot be kept is computed again: no reason to fail.
    with suppress(ConversionError):
        _store().save(key, arrays)


def _store() -> "ArrayCache":
    try:
        folder = Path(bpy.utils.extension_path_user(EXTENSION, path=FOLDER))
    except ValueError:  # not installed as an extension
        folder = Path(bpy.app.tempdir) / FOLDER
    return ArrayCache(folder)


def register() -> None:
    """Nothing to add: results are found when asked for."""


def unregister() -> None:
    """Let go of what is in memory."""
    forget()
