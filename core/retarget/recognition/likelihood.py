"""Log-likelihoods of measures, bounded, so that no single measure decides alone."""

import numpy as np

from ...arrays import Array

Measure = Array | float


def near(value: Measure, mean: float, deviation: float, most: float = 6.0) -> Array:
    """How well values (...) fit a mean: 0 at best, `-most` at worst."""
    return -np.minimum(0.5 * ((np.asarray(value) - mean) / deviation) ** 2, most)


def at_least(value: Measure, least: float, deviation: float, most: float = 8.0) -> Array:
    """0 for values (...) from `least` on, falling below it."""
    return near(np.minimum(np.asarray(value), least), least, deviation, most)


def at_most(value: Measure, largest: float, deviation: float, most: float = 8.0) -> Array:
    """0 for values (...) up to `largest`, falling above it."""
    return near(np.maximum(np.asarray(value), largest), largest, deviation, most)
