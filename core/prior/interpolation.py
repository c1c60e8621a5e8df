"""The prior mean between keyframes: a spline through them, cubic or linear, for every frame of the clip.

Before the first and after the last keyframe the posture is held.
"""

import numpy as np

from ..arrays import Array
from ..body.posture import Posture
from ..body.posture_spline import cubic_spline, linear_spline
from .keyframes import Keyframe


def interpolate(keyframes: tuple[Keyframe, ...], frame_count: int) -> Posture:
    """The a priori posture of every frame.

    Args:
        keyframes: At least two, in order of frame.
        frame_count: Frames F of the clip.

    Returns:
        A batch of F postures that passes through every keyframe.
    """
    return cubic_spline(*_posed(keyframes), np.arange(frame_count, dtype=np.float64))


def interpolate_linearly(keyframes: tuple[Keyframe, ...], frame_count: int) -> Posture:
    """Like `interpolate`, with constant velocity between keyframes (slerp): the plainest baseline."""
    return linear_spline(*_posed(keyframes), np.arange(frame_count, dtype=np.float64))


def _posed(keyframes: tuple[Keyframe, ...]) -> tuple[Posture, Array]:
    """The keyframes' postures and their frames (K,)."""
    index = np.array([keyframe.index for keyframe in keyframes], dtype=np.float64)
    return Posture.stack([keyframe.posture for keyframe in keyframes]), index
