"""The prior between keyframes: smooth curves per degree of freedom, on the manifold.

Each stretch between two keyframes is a cubic Hermite curve in the tangent space at the earlier one.
Tangents are the three-point (parabolic) estimate where neighbouring stretches agree in direction and
fall to zero where they do not, limited so that no component overshoots its keyframes (Fritsch & Carlson
1980, *Monotone Piecewise Cubic Interpolation*; the tangents are Hyman's 1983 form of the limit).
"""

import numpy as np
from numpy.typing import NDArray

from ..body import rotations
from ..body.posture import Posture
from .keyframes import Keyframe

Array = NDArray[np.float64]

MONOTONE_LIMIT = 3.0
"""Largest slope, in units of the smaller neighbouring slope, that keeps a cubic monotone."""


def interpolate(keyframes: tuple[Keyframe, ...], frame_count: int) -> Posture:
    """The a priori posture of every frame.

    Before the first and after the last keyframe the posture is held.

    Args:
        keyframes: At least two, in order of frame.
        frame_count: Frames F of the clip.

    Returns:
        A batch of F postures that passes through every keyframe.
    """
    index = np.array([k.index for k in keyframes], dtype=np.float64)
    posed = Posture.stack([k.posture for k in keyframes])
    step = posed[1:].minus(posed[:-1])  # (K-1, D), in the earlier keyframe's tangent space
    gap = np.diff(index)[:, None]
    tangent = _tangents(step / gap, gap)  # (K, D) per frame
    frame = np.clip(np.arange(frame_count), index[0], index[-1])
    stretch = np.clip(np.searchsorted(index, frame, side="right") - 1, 0, len(index) - 2)
    return posed[stretch].plus(_hermite(posed, step, gap, tangent, stretch, frame - index[stretch]))


def interpolate_linearly(keyframes: tuple[Keyframe, ...], frame_count: int) -> Posture:
    """Like `interpolate`, with constant velocity between keyframes (slerp): the plainest comparison."""
    index = np.array([k.index for k in keyframes], dtype=np.float64)
    posed = Posture.stack([k.posture for k in keyframes])
    frame = np.clip(np.arange(frame_count), index[0], index[-1])
    stretch = np.clip(np.searchsorted(index, frame, side="right") - 1, 0, len(index) - 2)
    share = (frame - index[stretch]) / np.diff(index)[stretch]
    return posed[stretch].plus(share[:, None] * posed[1:].minus(posed[:-1])[stretch])


def _tangents(slope: Array, gap: Array) -> Array:
    """Limited three-point tangents (K, D) from slopes (K-1, D) per frame and gaps (K-1, 1) in frames."""
    tangent = np.zeros((len(slope) + 1, slope.shape[1]))
    tangent[0], tangent[-1] = slope[0], slope[-1]
    before, after = slope[:-1], slope[1:]
    parabolic = (gap[1:] * before + gap[:-1] * after) / (gap[1:] + gap[:-1])
    limit = MONOTONE_LIMIT * np.minimum(np.abs(before), np.abs(after))
    agree = before * after > 0.0
    tangent[1:-1] = np.where(agree, np.clip(parabolic, -limit, limit), 0.0)
    return tangent


def _hermite(
    posed: Posture, step: Array, gap: Array, tangent: Array, stretch: NDArray[np.intp], elapsed: Array
) -> Array:
    """Tangent steps (F, D) from each frame's earlier keyframe."""
    skeleton = posed.skeleton
    # The later tangent is a body velocity at the later keyframe; J_r⁻¹ turns it into the curve's own rate.
    arrival = tangent[1:].copy()
    dofs = skeleton.ball_dofs
    arrival[:, dofs] = np.einsum(
        "kbij,kbj->kbi", rotations.right_jacobian_inverse(step[:, dofs]), tangent[1:][:, dofs]
    )
    u = (elapsed / gap[stretch, 0])[:, None]
    h = gap[stretch]
    return np.asarray(
        (u**3 - 2 * u**2 + u) * h * tangent[:-1][stretch]
        + (3 * u**2 - 2 * u**3) * step[stretch]
        + (u**3 - u**2) * h * arrival[stretch]
    )
