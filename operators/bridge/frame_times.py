"""Where the frames of a clip lie on the scene's time line."""

import numpy as np

from ...core.arrays import Array
from ...core.footage.clips.clip_timing import is_variable_frame_rate


def scene_frames(time_s: Array, first: float, rate: float) -> Array:
    """(F,) scene frame that shows each frame of a clip.

    One after the other for a constant rate, whatever the container's rounding of times; by their times,
    and so fractional, for a variable rate, as Blender shows them.

    Args:
        time_s: (F,) time of each frame from the first [s].
        first: Scene frame of the first.
        rate: Frames per second by which Blender places them.
    """
    if is_variable_frame_rate(time_s):
        return np.asarray(first + time_s * rate)
    return np.asarray(first + np.arange(len(time_s), dtype=np.float64))
