"""Constraints from posed keyframes on a match: the hips' place, the heading and roughly the posture."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.soles import sole_heights_m
from ..prior.keyframes import Keyframe
from .match_evidence import INDEPENDENT_POINTS

HIPS_STD_M = 0.03
"""Standard deviation of the hips' place in a posed keyframe: a person's error."""
POINT_STD_M = 0.08
"""Standard deviation of a point, the hips aligned: a library's posture is another performer's."""


@dataclass(frozen=True, eq=False)
class PosedConstraints:
    """K posed keyframes, in order of time."""

    body: Body
    frames: IndexArray
    """(K,) indices in the clip."""
    postures: tuple[Posture, ...]

    @classmethod
    def from_keyframes(cls, body: Body, keyframes: Sequence[Keyframe]) -> "PosedConstraints":
        """Constraints from those of a take's keyframes that a person has posed."""
        posed = sorted((each for each in keyframes if each.matched is None), key=lambda each: each.index)
        frames = np.array([each.index for each in posed], dtype=np.intp)
        return cls(body, frames, tuple(each.posture for each in posed))

    def __len__(self) -> int:
        """Number of posed keyframes."""
        return len(self.frames)

    @cached_property
    def hips(self) -> Array:
        """(K, 3) places of the hips [m]."""
        return np.array([posture.translation for posture in self.postures]).reshape(-1, 3)

    @cached_property
    def points(self) -> Array:
        """(K, P, 3) points relative to the hips [m]."""
        batch = Posture.stack(list(self.postures))
        return np.asarray(self.body.points(self.body.pose(batch)) - self.hips[:, None])

    def floor_m(self) -> float | None:
        """Height of the lowest sole in all posed keyframes [m]; None without any."""
        if not self.postures:
            return None
        batch = Posture.stack(list(self.postures))
        return float(sole_heights_m(self.body, self.body.pose(batch)).min())

    def hips_at(self, frame: int) -> Array | None:
        """(3,) the hips' place in a posed frame; None for any other."""
        found = np.flatnonzero(self.frames == frame)
        return self.hips[found[0]] if len(found) else None

    def cost(self, frame: int, points: Array, heading_rad: Array) -> SingleArray | None:
        """Cost of each state's difference from a posed frame.

        Args:
            frame: Index in the clip.
            points: (N, P, 3) of the library's postures, relative to the hips [m].
            heading_rad: (H,).

        Returns:
            (N H,) negative log likelihood, 0 for a usual difference; None where the frame is not posed.
        """
        found = np.flatnonzero(self.frames == frame)
        if not len(found):
            return None
        posed = self.points[found[0]]
        # |R p - q|² = |p|² + |q|² - 2 q R p, and q R p is linear in the heading's cosine and sine.
        level = np.einsum("npi,pi->n", points[..., :2], posed[:, :2])
        across = np.einsum("np,p->n", points[..., 0], posed[:, 1]) - np.einsum(
            "np,p->n", points[..., 1], posed[:, 0]
        )
        upright = np.einsum("np,p->n", points[..., 2], posed[:, 2])
        common = level[:, None] * np.cos(heading_rad) + across[:, None] * np.sin(heading_rad)
        squared = (points**2).sum(axis=(1, 2)) + (posed**2).sum() - 2.0 * upright
        mean = (squared[:, None] - 2.0 * common) / posed.shape[0]
        cost = 0.5 * INDEPENDENT_POINTS * (mean / POINT_STD_M**2 - 1.0)
        return np.asarray(cost.ravel(), dtype=np.float32)

    def residuals(self, points: Array, hips: Array) -> tuple[Array, Array]:
        """Residuals at the posed frames, in standard deviations.

        Args:
            points: (K, P, 3) of the match, relative to the hips [m].
            hips: (K, 3) places [m].

        Returns:
            (K, 3) of the hips and (K, 3 P) of the points.
        """
        count = self.points.shape[1]
        residual = (points - self.points) * (np.sqrt(INDEPENDENT_POINTS / count) / POINT_STD_M)
        return (hips - self.hips) / HIPS_STD_M, residual.reshape(len(residual), -1)
