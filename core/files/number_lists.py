"""Nested lists of numbers in JSON, read as arrays; text and truth values among them are refused."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from .kinds import Kind, refuse


def number_array(value: Any, *, nulls: bool = False) -> Array | None:
    """Nested lists of numbers as an array.

    Args:
        value: The value of a JSON field.
        nulls: Whether null may stand for a number, and becomes NaN; else all are finite.

    Returns:
        The array; None where lists of one level differ in length, or text, true, false or an object is among
        the numbers.
    """
    try:
        items = np.asarray(value, dtype=object)  # as float64, numpy would convert text and truth values
    except ValueError:  # lists of several lengths
        return None
    kinds = set(map(type, items.ravel())) - ({type(None)} if nulls else set())
    if not all(issubclass(kind, int | float) and kind is not bool for kind in kinds):
        return None
    array = items.astype(np.float64)
    return array if nulls or np.isfinite(array).all() else None


@dataclass(frozen=True)
class NumberArray(Kind):
    """Nested lists of numbers, an array once they are read."""

    shape: tuple[int, ...]
    """Lengths of its axes; -1 for any."""
    limit: float
    """Largest absolute value."""

    @property
    def valid(self) -> str:  # type: ignore[override]
        """Follows "it must be"."""
        words = " x ".join("any number" if length < 0 else str(length) for length in self.shape)
        return f"a list of numbers of shape {words}, each within {self.limit:g}"

    def read(self, value: Any, where: str, name: str) -> Array:
        """See `Kind`."""
        array = number_array(value)
        if array is None or array.ndim != len(self.shape) or not np.all(np.abs(array) <= self.limit):
            refuse(where, name, value, self.valid)
        if any(length not in (-1, given) for length, given in zip(self.shape, array.shape, strict=True)):
            refuse(where, name, value, self.valid)
        return array
