"""Many frames in stretches short enough that work on one needs little memory, and none takes long."""

import numpy as np
from numpy.typing import NDArray

Whole = NDArray[np.intp]


def chunks(index: Whole, longest: int) -> list[Whole]:
    """Indices (N,) in order, in about equal stretches of at most `longest`; one that is empty for none."""
    return np.array_split(index, max(1, -(-len(index) // longest)))
