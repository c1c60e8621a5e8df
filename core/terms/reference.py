"""A reference motion against its prediction: points about the hips, robust, with errors that last."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ..arrays import Array, BoolArray
from ..body.skeleton import SIDES
from .state import ClipState
from .term import NormalEquations, add_errors, errors_cost


@dataclass(frozen=True, eq=False)
class ExpectedPoints:
    """Where a reference motion has the principal points of F frames, and how far it errs."""

    points: Array  # (F, 13, 3) from the middle between the hips, in world axes [m]; NaN where not known
    whitening: Array  # (F, 13, 3, 3) takes errors in world axes [m] to standard deviations
    memory_s: float  # time in which an error fades to a third

    def __getitem__(self, frames: slice) -> "ExpectedPoints":
        return replace(self, points=self.points[frames], whitening=self.whitening[frames])

    def differ(self, other: "ExpectedPoints") -> BoolArray:
        """(F,) frames in which two say different things, by a thousandth of a meter or a twentieth."""
        moved = np.abs(np.nan_to_num(self.points, nan=9.0) - np.nan_to_num(other.points, nan=9.0))
        size = np.abs(np.log(np.abs(np.linalg.det(self.whitening) / np.linalg.det(other.whitening)))) / 3.0
        return np.asarray((moved.max(axis=(1, 2)) > 1e-3) | (size.max(axis=1) > 0.05))


@dataclass(frozen=True, eq=False)
class ReferenceTerm:
    """Compares the points about the hips with those of a reference motion."""

    expected: ExpectedPoints
    kept: Array  # (F - 1, 1) share of an error that is left in the next frame
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add three rows for each point; annealing does not touch them, since they are no image's."""
        error, used = self._errors(state)
        jacobian = state.body.points_jacobian(state.pose)
        jacobian = jacobian - jacobian[:, _hips(state)].mean(axis=1, keepdims=True)
        jacobian = self.expected.whitening @ jacobian
        add_errors(equations, error, used, jacobian, self.kept, 1.0, state.tangent_jacobian)

    def cost(self, state: ClipState) -> Array:
        """(F,) see `errors_cost`."""
        return errors_cost(*self._errors(state), self.kept)

    def _errors(self, state: ClipState) -> tuple[Array, BoolArray]:
        """(F, 13, 3) errors in standard deviations, and which are known (F, 13)."""
        points = state.body.points(state.pose)
        points = points - points[:, _hips(state)].mean(axis=1, keepdims=True)
        used = np.isfinite(self.expected.points).all(axis=-1)
        apart = np.where(used[..., None], points - self.expected.points, 0.0)
        return (self.expected.whitening @ apart[..., None])[..., 0], used


def _hips(state: ClipState) -> list[int]:
    return [state.body.skeleton.point_names.index(f"hip.{side}") for side in SIDES]
