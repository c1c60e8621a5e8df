"""Rows whose errors last: one that is off in a frame is off by nearly as much in the next.

Detectors err alike for many frames. Counted as independent their errors would average out, and be believed
far too much. They are first-order processes instead, e_t = φ e_t-1 + noise of variance 1 - φ² in units of the
error's own standard deviation, whose likelihood needs no unknowns of its own: a row for the first frame, and
e_t - φ e_t-1 for every later one (quasi-differences; Cochrane & Orcutt 1949). Where the error is known, at a
keyframe, it stays known for a while: near keyframes such rows say how the motion goes on and little of where
it is; far from them they say both.

Outliers are recognized twice, both by Student's t: as errors too large, which then tell of no other frame,
and as errors that change too fast, as they do where a detector jumps to another thing.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array, BoolArray
from ...numerics.robust import student_cost, student_weight
from .term import DEGREES, NormalEquations


@dataclass(frozen=True, eq=False)
class Drift:
    """Weights of N groups of G rows each in F frames."""

    level: Array
    """(F, N) weight as errors too large, 0 to 1; 0 for what is not seen."""
    own: Array
    """(F, N) information of the rows of a frame by themselves."""
    across: Array
    """(F - 1, N) information that couples the rows of a frame to those of the next."""
    pull: Array
    """(F, N, G) derivative of half the sum of squares by the errors."""


def drift(error: Array, used: BoolArray, kept: Array, temperature: float = 1.0) -> Drift:
    """The information that lasting errors have.

    Args:
        error: (F, N, G) errors over their standard deviations.
        used: (F, N) which of them are known.
        kept: (F - 1, 1) or (F - 1, N) share φ of an error that is left in the next frame.
        temperature: Factor of all variances.
    """
    error = np.where(used[..., None], error, 0.0)
    size = error.shape[-1]
    level = np.where(used, student_weight((error**2).sum(-1) / temperature, DEGREES, size), 0.0)
    fresh = np.maximum(1.0 - kept**2, 1e-6) * temperature
    change = error[1:] - kept[..., None] * error[:-1]
    both = np.sqrt(level[1:] * level[:-1])
    steady = student_weight((change**2).sum(-1) / fresh, DEGREES, size)
    linked = both * steady / fresh
    # What follows an outlier, or is followed after a gap, begins anew.
    begun = level / temperature
    begun[1:] *= 1.0 - both
    own = begun.copy()
    own[1:] += linked
    own[:-1] += kept**2 * linked
    pull = begun[..., None] * error
    pull[1:] += linked[..., None] * change
    pull[:-1] -= (kept * linked)[..., None] * change
    return Drift(level, own, -kept * linked, pull)


def drift_cost(error: Array, used: BoolArray, kept: Array) -> Array:
    """(F,) negative logarithm of Student's t of errors that last, up to a constant; arguments as of `drift`.

    An error costs by its change, in so far as it and the one before are none too large, else by its size.
    """
    error = np.where(used[..., None], error, 0.0)
    size, squared = error.shape[-1], (error**2).sum(-1)
    level = np.where(used, student_weight(squared, DEGREES, size), 0.0)
    change = error[1:] - kept[..., None] * error[:-1]
    both = np.sqrt(level[1:] * level[:-1])
    cost = np.where(used, student_cost(squared, DEGREES, size), 0.0)
    fresh = np.maximum(1.0 - kept**2, 1e-6)
    cost[1:] += both * (student_cost((change**2).sum(-1) / fresh, DEGREES, size) - cost[1:])
    return np.asarray(cost.sum(-1))


def add_drift(equations: NormalEquations, jacobian: Array, rows: Drift, tangent_jacobian: Array) -> None:
    """Add rows with lasting errors.

    Args:
        equations: The equations.
        jacobian: (F, N, G, D) derivative of the errors, over their standard deviations, by the
            posture's tangent.
        rows: Their weights.
        tangent_jacobian: (F, D, D) derivative of that by the leading unknowns.
    """
    frames, points, size, dofs = jacobian.shape
    flat = jacobian.reshape(frames, points * size, dofs) @ tangent_jacobian
    own, across = (np.repeat(weight, size, axis=-1)[..., None] for weight in (rows.own, rows.across))
    turned = np.swapaxes(flat, -1, -2)
    equations.matrix.diagonal[:, :dofs, :dofs] += turned @ (own * flat)
    equations.matrix.next[:, :dofs, :dofs] += turned[:-1] @ (across * flat[1:])
    equations.gradient[:, :dofs] += (turned @ rows.pull.reshape(frames, -1, 1))[..., 0]
