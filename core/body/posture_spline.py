"""A spline through postures, on the manifold: monotone cubic, one curve a degree of freedom.

Each interval between two knots is a cubic Hermite curve in the tangent space at the earlier posture.
Tangents are the three-point (parabolic) estimate where neighboring intervals agree in direction and
zero where they do not, limited so that no component overshoots its postures (Fritsch & Carlson
1980, *Monotone Piecewise Cubic Interpolation*; the tangents are Hyman's 1983 form of the limit).
"""

import numpy as np

from ..arrays import Array, IndexArray
from . import rotations
from .posture import Posture


def cubic_spline(posed: Posture, knots: Array, times: Array) -> Posture:
    """T postures of a monotone cubic through K ≥ 2, held before the first knot (K,) and after the last."""
    step = posed[1:].minus(posed[:-1])  # (K-1, D), in the earlier posture's tangent space
    gap = np.diff(knots)[:, None]
    # Limited three-point tangents (K, D) per unit of time.
    slope = step / gap
    tangent = np.zeros((len(slope) + 1, slope.shape[1]))
    tangent[0], tangent[-1] = slope[0], slope[-1]
    before, after = slope[:-1], slope[1:]
    parabolic = (gap[1:] * before + gap[:-1] * after) / (gap[1:] + gap[:-1])
    # Largest slope, in units of the smaller neighboring slope, that keeps a cubic monotone.
    limit = 3.0 * np.minimum(np.abs(before), np.abs(after))
    tangent[1:-1] = np.where(before * after > 0.0, np.clip(parabolic, -limit, limit), 0.0)
    interval, elapsed = find_intervals(knots, times)
    # The later tangent is a body velocity at the later posture; J_r⁻¹ turns it into the curve's own rate.
    arrival, dofs = tangent[1:].copy(), posed.skeleton.ball_dofs
    inverse = rotations.right_jacobian_inverse(step[:, dofs])
    arrival[:, dofs] = np.einsum("kbij,kbj->kbi", inverse, tangent[1:][:, dofs])
    h = gap[interval]
    u = elapsed[:, None] / h
    from_first = (u**3 - 2 * u**2 + u) * h * tangent[:-1][interval]
    to_last = (3 * u**2 - 2 * u**3) * step[interval] + (u**3 - u**2) * h * arrival[interval]
    return posed[interval].plus(from_first + to_last)


def find_intervals(knots: Array, times: Array) -> tuple[IndexArray, Array]:
    """Interval between knots (K,) that each time (T,) lies in, by its first knot, and the time since that."""
    held = np.clip(times, knots[0], knots[-1])
    interval = np.clip(np.searchsorted(knots, held, side="right") - 1, 0, len(knots) - 2)
    return interval, held - knots[interval]
