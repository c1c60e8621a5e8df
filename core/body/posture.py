"""Postures: values of the degrees of freedom, changed by tangent steps, never by adding Euler angles."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..errors import InputError, shown
from ..files.fields import Fields, child_location, listed
from ..files.kinds import Kind, Number, refuse
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
    translation: Array  # (..., 3) position of the hips' midpoint [m], world axes
    rotations: Array  # (..., B, 3, 3) rotation of each ball relative to its parent
    angles: Array  # (..., H) hinge angles [rad]

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

    @classmethod
    def where(cls, mask: BoolArray, first: "Posture", second: "Posture") -> "Posture":
        """The first of two batches of N where a mask (N,) holds, else the second, to the last digit."""
        return cls(
            first.skeleton,
            np.where(mask[:, None], first.translation, second.translation),
            np.where(mask[:, None, None, None], first.rotations, second.rotations),
            np.where(mask[:, None], first.angles, second.angles),
        )

    @property
    def batch(self) -> tuple[int, ...]:
        """Leading axes; () for a single posture."""
        return self.translation.shape[:-1]

    def __getitem__(self, index: Index) -> "Posture":
        """Postures selected along the batch axes."""
        return Posture(self.skeleton, self.translation[index], self.rotations[index], self.angles[index])

    def lowered(self, by_m: float) -> "Posture":
        """The postures so much lower."""
        return replace(self, translation=self.translation - [0.0, 0.0, by_m])

    def joint_turns(self) -> list[Array]:
        """(..., 3, 3) rotation of each joint relative to its parent, in the skeleton's order."""
        skeleton = self.skeleton
        turns: list[Array] = [np.eye(3)] * len(skeleton.joints)
        for column, ball in enumerate(skeleton.ball_joints):
            turns[ball] = self.rotations[..., column, :, :]
        hinged = rotations.exponential(self.angles[..., None] * skeleton.hinge_axes)
        for column, hinge in enumerate(skeleton.hinge_joints):
            turns[hinge] = hinged[..., column, :, :]
        return turns

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


# --- Postures as JSON fields


FARTHEST_M = 1000.0
LARGEST_ANGLE_RAD = 4.0 * np.pi
DECIMALS = 6  # micrometers and microradians: far below any measurement error, and files stay short


def posture_to_json(posture: Posture, decimals: int = DECIMALS) -> dict[str, Any]:
    """A posture, or a batch along the first axis, by name of degree of freedom [m, rad].

    `PostureValues` gives the same numbers back.
    """
    vector = posture.to_vector()  # (..., D)
    # Rounded up past π, half a turn would be read as half a turn the other way.
    turns = vector[..., posture.skeleton.ball_dofs]  # (..., B, 3)
    size = np.linalg.norm(turns, axis=-1, keepdims=True)
    longest = np.pi - 2.0 * 10.0**-decimals
    vector[..., posture.skeleton.ball_dofs] = turns * np.minimum(1.0, longest / np.maximum(size, 1.0))
    return dict(zip(posture.skeleton.dof_names, rounded(np.moveaxis(vector, -1, 0), decimals), strict=True))


def rounded(values: Array, decimals: int = DECIMALS) -> Any:
    """Nested lists of numbers, rounded, with no negative zero."""
    return (np.round(values, decimals) + 0.0).tolist()


@dataclass(frozen=True)
class PostureValues(Kind):
    """A single posture: its values by name of degree of freedom, in meters and radians."""

    skeleton: Skeleton
    farthest_m: float = FARTHEST_M  # largest distance from the origin along an axis [m]
    zeros_left_out: bool = False  # whether an absent degree of freedom is zero; else it is an error
    decimals: int = DECIMALS

    @property
    def valid(self) -> str:  # type: ignore[override]
        """Follows "it must be"."""
        return f"an object with {listed(self.skeleton.dof_names, 3)}"

    @property
    def numbers(self) -> Mapping[str, Number]:
        """The values by name: meters for locations, radians for angles."""
        place, angle = (
            Number(-self.farthest_m, self.farthest_m),
            Number(-LARGEST_ANGLE_RAD, LARGEST_ANGLE_RAD),
        )
        return {name: place if ".location_" in name else angle for name in self.skeleton.dof_names}

    def read(self, value: Any, where: str, name: str) -> Posture:
        """See `Kind`."""
        if not isinstance(value, Mapping):
            refuse(where, name, value, self.valid)
        fields, numbers = Fields(value, child_location(where, name)), self.numbers
        unknown = [one for one in value if one not in numbers]
        if unknown:
            raise InputError(
                f"{fields.where} names the unknown degree of freedom {shown(unknown[0])}; known are "
                f"{listed(numbers)}"
            )
        vector = [
            0.0
            if self.zeros_left_out and dof not in value
            else number.read(fields.required(dof, number.valid), fields.where, dof)
            for dof, number in numbers.items()
        ]
        return Posture.from_vector(self.skeleton, np.asarray(vector))

    def write(self, value: Posture) -> dict[str, float]:
        """See `Kind`."""
        values = posture_to_json(value, self.decimals)
        return {name: one for name, one in values.items() if one or not self.zeros_left_out}


# --- Headings


UP = np.array([0.0, 0.0, 1.0])


def yaw_rotation(angle_rad: Array | float) -> Array:
    """(..., 3, 3) rotations about the vertical by angles (...)."""
    return rotations.hinge(UP, np.asarray(angle_rad))


def facing_rad(direction: Array) -> float:
    """Heading of a world direction (3,); 0 where it points straight up or down."""
    x, y = float(direction[0]), float(direction[1])
    return float(np.arctan2(x, -y)) if np.hypot(x, y) > 1e-9 else 0.0


def headings_rad(posture: Posture) -> Array:
    """(F,) headings of the pelvis; of the line through the hips where the pelvis faces up or down."""
    return turn_headings_rad(posture.rotations[..., 0, :, :])


def turn_headings_rad(turn: Array) -> Array:
    """(F,) headings of turns (F, 3, 3); of what was across where they make the front face up or down."""
    ahead = np.arctan2(-turn[..., 0, 1], turn[..., 1, 1])
    across = np.arctan2(turn[..., 1, 0], turn[..., 0, 0])
    level = np.hypot(turn[..., 0, 1], turn[..., 1, 1])
    return np.where(level > np.sqrt(0.5), ahead, across)


def yawed_at(posture: Posture, angle_rad: Array | float, hips: Array) -> Posture:
    """N postures turned about the vertical by one angle or N, with their hips at points (N, 3) [m]."""
    matrices = np.array(posture.rotations)
    matrices[..., 0, :, :] = yaw_rotation(angle_rad) @ matrices[..., 0, :, :]
    return Posture(posture.skeleton, hips, matrices, posture.angles)


def yawed_in_place(posture: Posture, angle_rad: Array) -> Posture:
    """A single posture turned about the vertical through its hips by each of N angles: a batch of N."""
    batch = Posture.stack([posture] * len(angle_rad))
    return yawed_at(batch, angle_rad, batch.translation)


def turned_and_shifted(posture: Posture, angle_rad: Array | float, shift: Array) -> Posture:
    """F postures turned about the world's vertical axis, by one angle or F, then shifted [m]."""
    hips = (yaw_rotation(angle_rad) @ posture.translation[..., None])[..., 0] + shift
    return yawed_at(posture, angle_rad, hips)
