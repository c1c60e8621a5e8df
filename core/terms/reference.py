"""A reference motion against its prediction: points about the hips, robust, with errors that last."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray
from ..body.human import HIPS
from .term import ClipState, Rows, Term


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
class ReferenceTerm(Term):
    """Compares the points about the hips with those of a reference motion."""

    expected: ExpectedPoints
    lasting: Array

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """Three rows for each point; annealing does not touch them, since they are no image's."""
        points = state.body.points(state.pose)
        apart = points - points[:, HIPS].mean(axis=1, keepdims=True) - self.expected.points
        used = np.isfinite(apart).all(axis=-1)
        by = None
        if slopes:
            by = state.body.points_jacobian(state.pose)
            by = self.expected.whitening @ (by - by[:, HIPS].mean(axis=1, keepdims=True))
        yield Rows((self.expected.whitening @ apart[..., None])[..., 0], by, used)
