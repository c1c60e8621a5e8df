"""Timing of a clip: constant or variable frame rate, by its time stamps."""

import numpy as np
from numpy.typing import ArrayLike

RELATIVE_TOLERANCE = 0.1
STAMP_RESOLUTION_S = 1.1e-3  # containers that store whole milliseconds make even intervals jump by one


def is_variable_frame_rate(time_s: ArrayLike) -> bool:
    """Whether frames with these time stamps (F,) [s] are unevenly spaced in time.

    That is, whether an interval differs from the median by more than a tenth and more than a container's
    rounding to milliseconds explains. A dropped frame counts: Blender shows such clips by time, not by index.
    """
    intervals = np.diff(np.asarray(time_s, dtype=np.float64))
    if intervals.size < 2:
        return False
    median = float(np.median(intervals))
    tolerance = max(RELATIVE_TOLERANCE * median, STAMP_RESOLUTION_S)
    return bool(np.abs(intervals - median).max() > tolerance)
