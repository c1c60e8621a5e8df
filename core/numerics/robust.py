"""Student's t, under which errors far off count for less.

Lange, Little & Taylor (1989), *Robust statistical modeling using the t distribution*, JASA 84.
"""

from typing import TypeVar

import numpy as np

from ..arrays import Array, IndexArray, SingleArray

Floats = TypeVar("Floats", Array, SingleArray)


def student_weight(squared: Array, degrees: float, count: IndexArray | int) -> Array:
    """Weight of groups of rows whose t gets `degrees` for each row; 1 at zero.

    Args:
        squared: Sum of squared whitened residuals of each group.
        degrees: Degrees of freedom; fewer forgive more.
        count: Rows in each group.
    """
    return np.asarray(degrees / (degrees + squared / np.maximum(count, 1)))


def student_cost(squared: Array, degrees: float, count: int) -> Array:
    """Negative logarithm that `student_weight` belongs to, up to a constant."""
    size = degrees * count
    return np.asarray(0.5 * size * np.log1p(squared / size))


def multivariate_weight(squared: Array, degrees: float, dimensions: float) -> Array:
    """Weight of rows of a `dimensions`-variate t, (ν + d) / (ν + s), which is beyond 1 near zero."""
    return np.asarray((degrees + dimensions) / (degrees + squared))


def multivariate_cost(squared: Floats, degrees: float, dimensions: float) -> Floats:
    """Negative logarithm of a `dimensions`-variate t of squared distances, up to a constant."""
    return 0.5 * (degrees + dimensions) * np.log1p(squared / degrees)
