"""A smooth course through postures: curves per degree of freedom, on the manifold.

Each stretch between two postures is a cubic Hermite curve in the tangent space at the earlier one.
Tangents are the three-point (parabolic) estimate where neighboring stretches agree in direction and
fall to zero where they do not, limited so that no component overshoots its postures (Fritsch & Carlson
1980, *Monotone Piecewise Cubic Interpolation*; the tangents are Hyman's 1983 form of the limit).
"""

import numpy as np

from ..arrays import Array, IndexArray
from . import rotations
from .posture import Posture

MONOTONE_LIMIT = 3.0
"""Largest slope, in units of the smaller neighboring slope, that keeps a cubic monotone."""


def cubic_spline(posed: Posture, knots: Array, at: Array) -> Posture:
    """The posture at any time, led smoothly through those given.

    Before the first and after the last the posture is held.

    Args:
        posed: A batch of K postures, at least two.
        knots: (K,) their times, increasing, in any unit.
        at: (T,) the times asked for.

    Returns:
        A batch of T postures.
    """
    step = posed[1:].minus(posed[:-1])  # (K-1, D), in the earlier posture's tangent space
    gap = np.diff(knots)[:, None]
    tangent = _tangents(step / gap, gap)  # (K, D) per unit of time
    stretch, elapsed = find_intervals(knots, at)
    return posed[stretch].plus(_hermite(posed, step, gap, tangent, stretch, elapsed))


def linear_spline(posed: Posture, knots: Array, at: Array) -> Posture:
    """Like `cubic_spline`, with constant velocity between postures (slerp): the plainest comparison."""
    stretch, elapsed = find_intervals(knots, at)
    share = elapsed / np.diff(knots)[stretch]
    return posed[stretch].plus(share[:, None] * posed[1:].minus(posed[:-1])[stretch])


def find_intervals(knots: Array, at: Array) -> tuple[IndexArray, Array]:
    """Between which two knots (K,) each time (T,) lies, by the first of them, and how long after that one."""
    held = np.clip(at, knots[0], knots[-1])
    stretch = np.clip(np.searchsorted(knots, held, side="right") - 1, 0, len(knots) - 2)
    return stretch, held - knots[stretch]


def _tangents(slope: Array, gap: Array) -> Array:
    """Limited three-point tangents (K, D) from slopes (K-1, D) and gaps (K-1, 1)."""
    tangent = np.zeros((len(slope) + 1, slope.shape[1]))
    tangent[0], tangent[-1] = slope[0], slope[-1]
    before, after = slope[:-1], slope[1:]
    parabolic = (gap[1:] * before + gap[:-1] * after) / (gap[1:] + gap[:-1])
    limit = MONOTONE_LIMIT * np.minimum(np.abs(before), np.abs(after))
    agree = before * after > 0.0
    tangent[1:-1] = np.where(agree, np.clip(parabolic, -limit, limit), 0.0)
    return tangent


def _hermite(
    posed: Posture, step: Array, gap: Array, tangent: Array, stretch: IndexArray, elapsed: Array
) -> Array:
    """Tangent steps (F, D) from each time's earlier posture."""
    skeleton = posed.skeleton
    # The later tangent is a body velocity at the later posture; J_r⁻¹ turns it into the curve's own rate.
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
