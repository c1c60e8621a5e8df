"""Nested lists of numbers in JSON, read as arrays; text and truth values among them are refused."""

from typing import Any

import numpy as np

from ..arrays import Array


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
