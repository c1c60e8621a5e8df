"""Fields of a record as plain arrays for a cache, and back; none needs pickling."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, IndexArray

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
    """What a record's fields were; KeyError: an array is missing."""
    return {
        field.name: RESTORED[field.type](arrays[prefix + field.name])
        for field in fields(record)
        if field.type in RESTORED
    }
