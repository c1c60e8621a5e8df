"""Rows of the evidence at keyframes, with the parameters that are calibrated by them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from ..arrays import Array, BoolArray, IndexArray

UNUSED = 1e6  # variance of a row that does not count [px²]
LENS_DIFFERENCE = 1e-3  # of the logarithm of the focal length, over which slopes by it are taken


@dataclass(frozen=True, eq=False)
class EvidenceRows:
    """The rows R of one kind of evidence at J judged keyframes, with X parameters of its own."""

    residual: Array  # (J, R) predicted minus observed, at average parameters [px]
    by_parameters: Array  # (J, R, X)
    by_lens: Array  # (J, R) by the logarithm of the focal length
    by_posture: Array  # (J, R, D) by the posture's tangent
    variance: Array  # (J, R) at a perfectly posed keyframe [px²]; `UNUSED` for rows that do not count
    prior: Array  # (X, X) information of the parameters' prior

    @classmethod
    def apart(
        cls,
        usable: BoolArray,
        residual: Array,
        by_own: Array,
        by_lens: Array,
        by_posture: Array,
        variance: Array,
        prior: Array,
    ) -> "EvidenceRows":
        """The rows of N things of which each has parameters of its own.

        `usable` (J, N); `residual`, `by_lens` and `variance` (J, N, G); `by_own` (J, N, G, P) and
        `by_posture` (J, N, G, D).
        """
        judged, things, size = residual.shape
        rows, used = (judged, things * size), usable[..., None]
        own, index = np.zeros((judged, things, size, things, by_own.shape[-1])), np.arange(things)
        own[:, index, :, index] = np.moveaxis(np.where(used[..., None], by_own, 0.0), 1, 0)
        return cls(
            np.where(used, residual, 0.0).reshape(rows),
            own.reshape(*rows, things * by_own.shape[-1]),
            np.where(used, by_lens, 0.0).reshape(rows),
            np.where(used[..., None], by_posture, 0.0).reshape(*rows, by_posture.shape[-1]),
            np.where(used, variance, UNUSED).reshape(rows),
            prior,
        )


@dataclass(frozen=True, eq=False)
class KeyframeRows:
    """The rows of all evidence, R of them, with all parameters: X, of which the last is the lens."""

    residual: Array  # (J, R)
    parameter_jacobian: Array  # (J, R, X)
    variance: Array  # (J, R)
    posing: Array  # (J, R, R) covariance that a person's usual posing error adds
    prior: Array  # (X, X)

    @classmethod
    def stacked(cls, parts: Sequence[EvidenceRows], posing: Array) -> "KeyframeRows":
        """The rows of several kinds of evidence, one after the other.

        `posing` (J, D, D) is the usual posing error.
        """
        judged = len(posing)
        rows = [part.residual.shape[1] for part in parts]
        own = [part.by_parameters.shape[2] for part in parts]
        parameters = np.zeros((judged, sum(rows), sum(own) + 1))
        row = column = 0
        for part, height, width in zip(parts, rows, own, strict=True):
            parameters[:, row : row + height, column : column + width] = part.by_parameters
            parameters[:, row : row + height, -1] = part.by_lens
            row, column = row + height, column + width
        jacobian = np.concatenate([part.by_posture for part in parts], axis=1)
        # 0.03: standard deviation of a stated focal length, as a share
        return cls(
            np.concatenate([part.residual for part in parts], axis=1),
            parameters,
            np.concatenate([part.variance for part in parts], axis=1),
            jacobian @ posing @ np.swapaxes(jacobian, -1, -2),
            block_diag(*(part.prior for part in parts), 0.03**-2),
        )

    def part(self, rows: BoolArray, parameters: BoolArray) -> "KeyframeRows":
        """Some of the rows (R,), with the parameters (X,) that they depend on."""
        return KeyframeRows(
            self.residual[:, rows],
            self.parameter_jacobian[:, rows][:, :, parameters],
            self.variance[:, rows],
            self.posing[:, rows][:, :, rows],
            self.prior[np.ix_(parameters, parameters)],
        )

    def gathered(self, noise: Array) -> tuple[Array, Array, Array]:
        """Inverse noise, information (X, X) of the parameters with their prior, right-hand side (X,)."""
        inverse = np.linalg.inv(noise)
        weighted = np.swapaxes(self.parameter_jacobian, -1, -2) @ inverse
        information = (weighted @ self.parameter_jacobian).sum(axis=0) + self.prior
        return inverse, information, (weighted @ self.residual[..., None]).sum(axis=0)[:, 0]

    def calibrated(self, weight: Array, scale: float) -> tuple[Array, Array]:
        """Most probable change (X,) of the parameters, and the rows (J, R) that it leaves; as `noise`."""
        _, information, right = self.gathered(self.noise(weight, scale))
        change = -np.linalg.solve(information, right)
        return change, self.residual + self.parameter_jacobian @ change

    def squared(self, left: Array, size: IndexArray, scale: float) -> Array:
        """(J, G) squares, in standard deviations, of rows that are left: groups of `size` (G,) rows each."""
        expected = self.noise(np.ones_like(left), scale)
        squared = np.empty((len(left), len(size)))
        first = np.cumsum(size) - size
        for count in np.unique(size):
            index = first[size == count][:, None] + np.arange(count)
            rows = left[:, index]
            own = expected[:, index[:, :, None], index[:, None, :]]
            solved = np.linalg.solve(own, rows[..., None])
            squared[:, size == count] = (rows[..., None, :] @ solved)[..., 0, 0]
        return squared

    def noise(self, weight: Array, scale: float) -> Array:
        """(J, R, R) covariance of the rows without the parameters' own.

        `weight` (J, R) is 1 for a row that is no outlier, `scale` the posing error's size relative to a usual
        one.
        """
        total = scale**2 * self.posing
        rows = np.arange(total.shape[-1])
        total[:, rows, rows] += self.variance / weight
        return total
