"""Blender's own interpolation of keyframes: F-curves with auto-clamped handles on quaternion components.

A reimplementation for comparison, in the form of cubic Hermite curves: a handle's slope is that of the line
through both neighbors, zero at an extremum and at the ends, and no handle's end passes a neighbor's value.
Blender's handles are 1/2.5614 of a gap long instead of 1/3, which bends time a little; that is left out.
"""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body import rotations
from keymark.core.body.posture import Posture
from keymark.core.prior.keyframes import Keyframe

HANDLES_PER_GAP = 3.0


def interpolate_auto_clamped(keyframes: tuple[Keyframe, ...], frame_count: int) -> Posture:
    """A batch of `frame_count` postures through the keyframes, held before the first and after the last."""
    index = np.array([keyframe.index for keyframe in keyframes], dtype=np.float64)
    posed = Posture.stack([keyframe.posture for keyframe in keyframes])
    frame = np.clip(np.arange(frame_count), index[0], index[-1])
    quaternions = rotations.continuous_quaternions(rotations.to_quaternions(posed.rotations))  # (K, B, 4)
    curves = _curve(index, quaternions.reshape(len(index), -1), frame)
    components = curves.reshape(frame_count, -1, 4)
    components /= np.linalg.norm(components, axis=-1, keepdims=True)
    return Posture(
        posed.skeleton,
        _curve(index, posed.translation, frame),
        _matrices(components),
        _curve(index, posed.angles, frame),
    )


def _curve(index: Array, values: Array, frame: Array) -> Array:
    """Curves (F, C) through values (K, C) at `index` (K,), at the frames (F,)."""
    gap = np.diff(index)[:, None]
    slope = np.zeros_like(values)
    slope[1:-1] = (values[2:] - values[:-2]) / (gap[1:] + gap[:-1])
    before, after = np.diff(values, axis=0)[:-1], np.diff(values, axis=0)[1:]
    slope[1:-1][before * after <= 0.0] = 0.0
    steepest = HANDLES_PER_GAP * np.minimum(np.abs(before) / gap[:-1], np.abs(after) / gap[1:])
    slope[1:-1] = np.clip(slope[1:-1], -steepest, steepest)
    stretch = np.clip(np.searchsorted(index, frame, side="right") - 1, 0, len(index) - 2)
    width = gap[stretch]
    u = (frame - index[stretch])[:, None] / width
    return np.asarray(
        (2 * u**3 - 3 * u**2 + 1) * values[stretch]
        + (u**3 - 2 * u**2 + u) * width * slope[stretch]
        + (3 * u**2 - 2 * u**3) * values[stretch + 1]
        + (u**3 - u**2) * width * slope[stretch + 1]
    )


def _matrices(quaternions: Array) -> Array:
    """Rotation matrices (..., 3, 3) of unit quaternions (..., 4) in the order w, x, y, z."""
    w, v = quaternions[..., :1], quaternions[..., 1:]
    sine = np.linalg.norm(v, axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, w)
    scale = np.where(sine > 1e-12, angle / np.where(sine > 1e-12, sine, 1.0), 2.0)
    return rotations.exponential(scale * v)
