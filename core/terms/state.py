"""The unknowns of a window of a clip, or of one frame."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body, Pose
from ..body.posture import Posture


@dataclass(frozen=True, eq=False)
class ClipState:
    """Unknowns of a window or a frame, N = D + B in each of F frames.

    The first D unknowns z describe the deviation δ = L z from the prior, `posture = prior.plus(deviation)`;
    the factor L makes their accelerations independent and of unit size. The others are biases of image
    features.
    """

    body: Body
    prior: Posture  # a batch of F postures
    frame: IndexArray  # (F,) their indices in the clip, which a moving camera's pose depends on
    factor: Array  # (D, D) the matrix L [m, rad]
    variation: Array  # (F, D) the unknowns z
    bias: Array  # (F, B) [px]

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
    def tangent_jacobian(self) -> Array:
        """(F, D, D) Jacobian of the posture's own tangent by the unknowns z."""
        return np.asarray(self.prior.plus_jacobian(self.deviation) @ self.factor)

    def without_cache(self) -> "ClipState":
        """The same state without its cached properties, for which a long clip has no room."""
        return replace(self)

    def of_frames(self, frames: slice) -> "ClipState":
        """The state of some of its frames."""
        return replace(
            self,
            prior=self.prior[frames],
            frame=self.frame[frames],
            variation=self.variation[frames],
            bias=self.bias[frames],
        )

    def stepped(self, step: Array, largest: float) -> tuple["ClipState", float]:
        """The state a step (F, N) away, and the largest change of its postures.

        A frame's step is shortened so that no component of its deviation changes by more than `largest`.
        """
        count = self.variation.shape[1]
        moved = np.abs(step[:, :count] @ self.factor.T).max(axis=1)
        shrink = np.minimum(1.0, largest / np.maximum(moved, 1e-12))
        variation = self.variation + step[:, :count] * shrink[:, None]
        bias = self.bias + step[:, count:]
        return replace(self, variation=variation, bias=bias), float((moved * shrink).max())
