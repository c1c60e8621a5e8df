"""The unknowns of a whole clip: each frame's deviation from the prior and the slow biases of its features."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Body, Pose
from ..body.posture import Posture

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ClipState:
    """A point of the whole clip's estimation problem, with N = D + B unknowns a frame.

    The first D unknowns are the deviation δ from the prior, `posture = prior.plus(deviation)`; the
    others are biases of image features.
    """

    body: Body
    prior: Posture
    """A batch of F postures."""
    frame: NDArray[np.intp]
    """(F,) their places in the clip, by which a moving camera knows its pose."""
    deviation: Array
    """(F, D) [m, rad]."""
    bias: Array
    """(F, B) [px]."""

    @property
    def frames(self) -> int:
        """Number of frames F."""
        return len(self.deviation)

    @property
    def unknowns(self) -> Array:
        """(F, N) deviation and bias side by side."""
        return np.concatenate([self.deviation, self.bias], axis=1)

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
        """(F, D, D) takes Jacobians by a posture's own tangent to Jacobians by its deviation."""
        return self.prior.plus_jacobian(self.deviation)

    def stepped(self, step: Array) -> "ClipState":
        """The state a step (F, N) away."""
        count = self.deviation.shape[1]
        deviation, bias = self.deviation + step[:, :count], self.bias + step[:, count:]
        return ClipState(self.body, self.prior, self.frame, deviation, bias)
