"""Directions in space."""

import numpy as np

from ..arrays import Array

SHORTEST = 1e-12
"""Length below which a vector has no direction."""


def unit(vectors: Array) -> Array:
    """Vectors (..., N) made one long; those without a direction stay short."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, SHORTEST))


def across(vector: Array) -> Array:
    """Some unit vector (3,) at right angles to a vector (3,)."""
    return unit(np.cross(vector, np.eye(3)[np.argmin(np.abs(vector))]))
