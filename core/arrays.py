"""Arrays: the types that signatures name, and long index arrays in chunks."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SingleArray = NDArray[np.float32]
IndexArray = NDArray[np.intp]
Int32Array = NDArray[np.int32]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
Image = NDArray[np.uint8]


def chunks(index: IndexArray, longest: int) -> list[IndexArray]:
    """Cut indices (N,) into about equal chunks of at most `longest`; no indices make one empty chunk.

    Work on a chunk after the other needs the memory of one, and a job can yield in between.
    """
    return np.array_split(index, max(1, -(-len(index) // longest)))
