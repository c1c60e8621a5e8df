"""The unknowns of a whole clip: each frame's deviation from the prior and the slow biases of its features."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body, Pose
from ..body.posture import Posture


@dataclass(frozen=True, eq=False)
class ClipState:
    """A point of the whole clip's estimation problem, with N = D + B unknowns a frame.

    The first D unknowns z describe the deviation δ = L z from the prior, `posture = prior.plus(deviation)`;
    the factor L makes their accelerations independent and of unit size. The others are biases of image
    features.
    """

    body: Body
    prior: Posture
    """A batch of F postures."""
    frame: IndexArray
    """(F,) their places in the clip, by which a moving camera knows its pose."""
    factor: Array
    """(D, D) the matrix L [m, rad]."""
    variation: Array
    """(F, D) the unknowns z."""
    bias: Array
    """(F, B) [px]."""

    @property
    def frames(self) -> int:
        """Number of frames F."""
        return len(self.variation)

    @property
    def unknowns(self) -> Array:
        """(F, N) variation and bias side by side."""
        return np.concatenate([self.variation, self.bias], axis=1)

    @cached_property
    def deviation(self) -> Array:
        """(F, D) deviation δ from the prior [m, rad]."""
        return self.variation @ self.factor.T

    @cached_property
    def posture(self) -> Posture:
        """The batch of F estimated postures."""
        return self.prior.plus(self.deviation)

    @cached_property
    def pose(self) -> Pose:
        """Forward kinematics of the postures."""
        return self.body.pose(self.posture)

    @cached_property
    def chain(self) -> Array:
        """(F, D, D) takes Jacobians by a posture's own tangent to Jacobians by the unknowns z."""
        return np.asarray(self.prior.plus_jacobian(self.deviation) @ self.factor)

    def bare(self) -> "ClipState":
        """The same without what was computed from it on the way, which a long clip has no room to keep."""
        return replace(self)

    def stepped(self, step: Array, largest: float) -> tuple["ClipState", float]:
        """The state a step (F, N) away, and how far its postures moved.

        Args:
            step: Step of all unknowns.
            largest: A frame whose deviation would change by more in any component is held back to it.
        """
        count = self.variation.shape[1]
        moved = np.abs(step[:, :count] @ self.factor.T).max(axis=1)
        held = np.minimum(1.0, largest / np.maximum(moved, 1e-12))
        variation = self.variation + step[:, :count] * held[:, None]
        bias = self.bias + step[:, count:]
        return replace(self, variation=variation, bias=bias), float((moved * held).max())
