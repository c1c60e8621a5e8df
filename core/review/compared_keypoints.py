"""Keypoints beside the places where the motion puts them: which were followed, and how well."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, IndexArray
from ..detect.keypoints import FACE
from .confidence import misfits

Arrays = Mapping[str, NDArray[Any]]

RESTORED: dict[Any, Callable[[NDArray[Any]], Any]] = {
    Array: lambda array: np.asarray(array, dtype=np.float64),
    BoolArray: lambda array: np.asarray(array, dtype=np.bool_),
    IndexArray: lambda array: np.asarray(array, dtype=np.intp),
    tuple[str, ...]: lambda array: tuple(array.tolist()),
    tuple[int, int]: lambda array: tuple(map(int, array.tolist())),
}
"""How a field is restored, by its type; fields of other types are left out."""


def to_arrays(record: Any, drawn: Collection[str], prefix: str = "") -> dict[str, NDArray[Any]]:
    """A record's fields by name after a prefix; those that are only drawn are in single precision."""
    arrays = {}
    for field in fields(record):
        if field.type in RESTORED:
            kind = np.str_ if field.type == tuple[str, ...] else np.float32 if field.name in drawn else None
            arrays[prefix + field.name] = np.asarray(getattr(record, field.name), dtype=kind)
    return arrays


def from_arrays(record: type[Any], arrays: Arrays, prefix: str = "") -> dict[str, Any]:
    """What a record's fields were.

    Raises:
        KeyError: An array is missing.
    """
    return {
        field.name: RESTORED[field.type](arrays[prefix + field.name])
        for field in fields(record)
        if field.type in RESTORED
    }


PREFIX = "keypoint_"  # of the names of the arrays in a cache
DRAWN = ("seen", "predicted", "confidence", "distance_px", "expected_px")
PARTS = {
    **{name.partition(".")[0]: "head" for name in (*FACE, "crown")},
    **dict.fromkeys(("index", "thumb", "pinky"), "wrist"),
    **dict.fromkeys(("heel", "toe", "small_toe"), "ankle"),
}
"""Points that lie beside a principal point, and err and hide with it."""


def part_of(name: str) -> str:
    """The principal point, neck or pelvis for which a body point stands: the head for an ear."""
    stem, dot, side = name.partition(".")
    part = PARTS.get(stem)
    if part is None:
        return name
    return part if part == "head" else f"{part}{dot}{side}"


@dataclass(frozen=True, eq=False)
class ComparedKeypoints:
    """N keypoints in F frames; NaN where there is none."""

    names: tuple[str, ...]  # (N,) the body point each shows
    sources: tuple[str, ...]  # (N,) what saw each
    seen: Array  # (F, N, 2) where each was seen [px], left and right exchanged back if swapped
    predicted: Array  # (F, N, 2) where the motion puts it [px]
    confidence: Array  # (F, N) of its source, 1 for what it is sure of, 0 where not seen
    distance_px: Array  # (F, N) between the two; NaN where not compared
    expected_px: Array  # (F, N) std of each coordinate of that distance; infinite for what is left out
    thrown_out: BoolArray  # (F, N) seen, but not believed
    swapped: BoolArray  # (F, N) seen on the other side of the body by its source

    @classmethod
    def none(cls, frames: int) -> "ComparedKeypoints":
        """No keypoint at all, N = 0."""
        places, numbers, no = np.zeros((frames, 0, 2)), np.zeros((frames, 0)), np.zeros((frames, 0), bool)
        return cls((), (), places, places, numbers, numbers, numbers, no, no)

    @property
    def misfit(self) -> Array:
        """(F, N) reduced squared distances: 1 on average where the noise is as assumed; NaN if unknown."""
        known = np.where(np.isfinite(self.expected_px), self.distance_px, np.nan)
        return misfits(known, self.expected_px)

    def parts(self) -> tuple[str, ...]:
        """The K parts of the body that any keypoint stands for, in the order of the keypoints."""
        return tuple(self._columns())

    def by_part(self, values: Array) -> Array:
        """(F, K) medians of values (F, N) over each part, on which detectors err alike; NaN where all are."""
        columns = self._columns()
        result = np.full((len(values), len(columns)), np.nan)
        for part, own in enumerate(columns.values()):
            known = np.isfinite(values[:, own]).any(axis=1)
            result[known, part] = np.nanmedian(values[known][:, own], axis=1)
        return result

    def quality(self) -> Array:
        """(F, K) confidence of each part's best keypoint; 1 where a part that is seldom seen is not."""
        best = [self.confidence[:, own].max(axis=1) for own in self._columns().values()]
        if not best:
            return np.zeros((len(self.confidence), 0))
        quality = np.stack(best, axis=1)
        # Share of the frames in which a part is seen that is missed in the others.
        seldom = (quality > 0.0).mean(axis=0) < 0.5
        return np.where(seldom & (quality == 0.0), 1.0, quality)

    def _columns(self) -> dict[str, list[int]]:
        """The keypoints of each part, without those that are never seen or left out all along."""
        columns: dict[str, list[int]] = {}
        followed = np.isfinite(self.expected_px) & (self.confidence > 0.0)
        for index in np.flatnonzero(followed.any(axis=0)).tolist():
            columns.setdefault(part_of(self.names[index]), []).append(index)
        return columns

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """All fields as plain arrays for `from_arrays`; places and numbers are only drawn."""
        return to_arrays(self, DRAWN, PREFIX)

    @classmethod
    def from_arrays(cls, arrays: Arrays, frames: int) -> "ComparedKeypoints":
        """Restore them; none from arrays of before there were keypoints.

        Raises:
            KeyError: An array is missing.
        """
        known = PREFIX + "names" in arrays
        return cls(**from_arrays(cls, arrays, PREFIX)) if known else cls.none(frames)
