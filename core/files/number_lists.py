"""Nested lists of numbers as arrays: whatever is not numbers through and through is none."""

from typing import Any

import numpy as np

from ..arrays import Array


def number_array(value: Any, *, nulls: bool = False) -> Array | None:
    """Nested lists of numbers as an array, each list of a level being as long as the others.

    Args:
        value: What a JSON file holds.
        nulls: Whether null may stand for a number, and becomes NaN; else all are finite.

    Returns:
        The array; None where a text, true or false, an object or a list of another length is among them.
    """
    try:
        things = np.asarray(value, dtype=object)  # numpy would take texts and truth values for numbers
    except ValueError:  # lists of several lengths
        return None
    kinds = set(map(type, things.ravel())) - ({type(None)} if nulls else set())
    if not all(issubclass(kind, int | float) and kind is not bool for kind in kinds):
        return None
    array = things.astype(np.float64)
    return array if nulls or np.isfinite(array).all() else None
