"""Angles of joints over time, without leaps that no joint makes and without a tremor from frame to frame."""

import numpy as np

from ..arrays import Array
from ..numerics.smoothing import gaussian, usual_step

FASTEST_RAD_S = np.radians(700.0)
"""Angular speed of an ankle in a sprinter's push-off."""
SMOOTHING_S = 0.03


def steadied(angles: Array, time_s: Array) -> Array:
    """Angles (F, ...) no faster than a joint, smoothed a little.

    Args:
        angles: (F, ...) [rad].
        time_s: (F,) rising times [s].
    """
    if len(time_s) < 2:
        return angles
    slow = _slowed(angles, FASTEST_RAD_S * np.diff(time_s))
    return gaussian(slow, SMOOTHING_S / usual_step(time_s), truncate=3.0)


def _slowed(angles: Array, steps: Array) -> Array:
    """Angles that change by no more than given steps (F - 1,); those that do not anyway stay as they are.

    The mean of the lowest such curve above them and the highest below.
    """
    above, below = angles.copy(), angles.copy()
    for frame, step in enumerate(steps):
        above[frame + 1] = np.maximum(above[frame + 1], above[frame] - step)
        below[frame + 1] = np.minimum(below[frame + 1], below[frame] + step)
    for frame in range(len(steps) - 1, -1, -1):
        above[frame] = np.maximum(above[frame], above[frame + 1] - steps[frame])
        below[frame] = np.minimum(below[frame], below[frame + 1] + steps[frame])
    return np.asarray(0.5 * (above + below))
