"""Arrays: the types that signatures name, long index arrays in chunks, and arrays that stay as they are."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SingleArray = NDArray[np.float32]
IndexArray = NDArray[np.intp]
Int32Array = NDArray[np.int32]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
Image = NDArray[np.uint8]


def single(values: Array | SingleArray) -> SingleArray:
    """Values in single precision, where thousands are compared."""
    return np.asarray(values, dtype=np.float32)


def chunks(index: IndexArray, longest: int) -> list[IndexArray]:
    """Cut indices (N,) into about equal chunks of at most `longest`; no indices make one empty chunk.

    Work on a chunk after the other needs the memory of one, and a job can yield in between.
    """
    return np.array_split(index, max(1, -(-len(index) // longest)))


def freeze(owner: object, shapes: Mapping[str, tuple[int, ...]], flags: tuple[str, ...] = ()) -> None:
    """Make fields of a frozen dataclass read-only copies: truth values where `flags` name them, else numbers.

    Raises:
        ValueError: One has another shape.
    """
    for name, shape in shapes.items():
        array = np.array(getattr(owner, name), dtype=np.bool_ if name in flags else np.float64)
        if array.shape != shape:
            raise ValueError(f"{name} has the shape {array.shape}, not {shape}")
        array.setflags(write=False)
        object.__setattr__(owner, name, array)
