"""Reading a number off a measured curve."""

import numpy as np
from numpy.typing import ArrayLike


def needed_for(limit: float, densities: ArrayLike, errors: ArrayLike) -> float | None:
    """The density from which on an error stays within a limit.

    Between measured densities the error is interpolated linearly over the density's logarithm.

    Args:
        limit: The error that is good enough.
        densities: (N,) rising.
        errors: (N,) at these densities, in the limit's unit.

    Returns:
        The density; the lowest measured one where that is within the limit, None where the highest is not.
    """
    density, error = np.asarray(densities, dtype=np.float64), np.asarray(errors, dtype=np.float64)
    beyond = np.flatnonzero(error > limit)
    if not len(beyond):
        return float(density[0])
    last = int(beyond[-1])
    if last == len(density) - 1:
        return None
    share = (error[last] - limit) / (error[last] - error[last + 1])
    first, second = np.log(density[last : last + 2])
    return float(np.exp(first + share * (second - first)))
