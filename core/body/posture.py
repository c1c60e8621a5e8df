"""Postures: values of the degrees of freedom, changed by tangent steps, never by adding Euler angles."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from . import rotations
from .skeleton import Skeleton

Index = int | slice | IndexArray | BoolArray | tuple[slice | None, ...]


@dataclass(frozen=True, eq=False)
class Posture:
    """One posture or a batch of them; arrays are stored read-only.

    The tangent space has D coordinates in the order of `skeleton.dof_names`: translation [m] in world
    axes, each ball's rotation [rad] in its child frame, each hinge's angle [rad]. For every posture x
    and step δ below π per ball, `x.plus(δ).minus(x) == δ`.
    """

    skeleton: Skeleton
    translation: Array
    """(..., 3) position of the hips' midpoint [m], world axes."""
    rotations: Array
    """(..., B, 3, 3) rotation of each ball relative to its parent."""
    angles: Array
    """(..., H) hinge angles [rad]."""

    def __post_init__(self) -> None:
        """Keep read-only copies of the arrays."""
        for name in ("translation", "rotations", "angles"):
            value = np.array(getattr(self, name), dtype=np.float64)
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    @classmethod
    def rest(cls, skeleton: Skeleton, batch: tuple[int, ...] = ()) -> "Posture":
        """The rest posture (T pose, hips at the origin), repeated over `batch`."""
        balls, hinges = len(skeleton.ball_joints), len(skeleton.hinge_joints)
        return cls(
            skeleton,
            np.zeros((*batch, 3)),
            np.broadcast_to(np.eye(3), (*batch, balls, 3, 3)),
            np.zeros((*batch, hinges)),
        )

    @classmethod
    def from_vector(cls, skeleton: Skeleton, vector: Array) -> "Posture":
        """The posture of a posture vector (..., D): translations, rotation vectors and angles."""
        v = np.asarray(vector, dtype=np.float64)
        return cls.rest(skeleton, v.shape[:-1]).plus(v)

    @classmethod
    def stack(cls, postures: list["Posture"]) -> "Posture":
        """One batch of several postures, along a new first axis."""
        return cls(
            postures[0].skeleton,
            np.stack([p.translation for p in postures]),
            np.stack([p.rotations for p in postures]),
            np.stack([p.angles for p in postures]),
        )

    @classmethod
    def concatenate(cls, batches: list["Posture"]) -> "Posture":
        """One batch of several, joined along their first axis."""
        return cls(
            batches[0].skeleton,
            np.concatenate([p.translation for p in batches]),
            np.concatenate([p.rotations for p in batches]),
            np.concatenate([p.angles for p in batches]),
        )

    @property
    def batch(self) -> tuple[int, ...]:
        """Leading axes; () for a single posture."""
        return self.translation.shape[:-1]

    def __getitem__(self, index: Index) -> "Posture":
        """Postures selected along the batch axes."""
        return Posture(self.skeleton, self.translation[index], self.rotations[index], self.angles[index])

    def to_vector(self) -> Array:
        """The posture vector (..., D) for `from_vector`; rotation vectors of at most π."""
        return self.minus(Posture.rest(self.skeleton, self.batch))

    def plus(self, delta: Array) -> "Posture":
        """The posture a tangent step (..., D) away; batches broadcast."""
        step = np.asarray(delta, dtype=np.float64)
        turn = rotations.exponential(step[..., self.skeleton.ball_dofs])
        return Posture(
            self.skeleton,
            self.translation + step[..., :3],
            self.rotations @ turn,
            self.angles + step[..., self.skeleton.hinge_dofs],
        )

    def minus(self, other: "Posture") -> Array:
        """The tangent step (..., D) that leads from `other` to this posture."""
        turn = rotations.logarithm(np.swapaxes(other.rotations, -1, -2) @ self.rotations)
        step = np.zeros((*turn.shape[:-2], self.skeleton.dof_count))
        step[..., :3] = self.translation - other.translation
        step[..., self.skeleton.ball_dofs] = turn
        step[..., self.skeleton.hinge_dofs] = self.angles - other.angles
        return step

    def plus_jacobian(self, delta: Array) -> Array:
        """d(plus(delta) as a tangent at the result) / d delta: (..., D, D), block diagonal.

        A Jacobian taken at `x.plus(delta)` with respect to its own tangent, times this matrix, is the
        Jacobian with respect to `delta`.
        """
        step = np.asarray(delta, dtype=np.float64)
        count = self.skeleton.dof_count
        jacobian = np.zeros((*step.shape[:-1], count, count))
        jacobian[..., np.arange(count), np.arange(count)] = 1.0
        dofs = self.skeleton.ball_dofs
        jacobian[..., dofs[:, :, None], dofs[:, None, :]] = rotations.right_jacobian(step[..., dofs])
        return jacobian
