"""A motion as the character performs it: the poses of the bones that play a role, before any control."""

from collections.abc import Mapping
from dataclasses import dataclass

from ..arrays import Array


@dataclass(frozen=True, eq=False)
class Similarity:
    """From the armature's space to the world: turn, place and one scale."""

    rotation: Array
    """(3, 3)."""
    location: Array
    """(3,) [m]."""
    scale: float

    def to_world(self, points: Array) -> Array:
        """World coordinates (..., 3) of points in the armature's space [m]."""
        return self.location + self.scale * (points @ self.rotation.T)

    def from_world(self, points: Array) -> Array:
        """The inverse of `to_world`."""
        return (points - self.location) @ self.rotation / self.scale


@dataclass(frozen=True, eq=False)
class FootRest:
    """A foot of the character at rest on the ground."""

    limb: str
    """`leg.L` or `leg.R`."""
    first: int
    """The first frame of the rest, from 0."""
    last: int
    """Its last frame, included."""
    floor_m: float
    """Height of the ground there, along the character's up [m]."""


@dataclass(frozen=True, eq=False)
class CharacterMotion:
    """Poses of the role bones in F frames, in the armature's space and units."""

    poses: Mapping[str, Array]
    """(F, 4, 4) by name of bone: the posed matrix of every bone that plays a role and is not left alone."""
    bends: Mapping[str, Array]
    """(F, 3) by limb: unit vector from the line through the limb's ends toward its elbow or knee, without
    flips."""
    root: Array | None
    """(F, 4, 4) posed matrix of the root bone; None where it stays at rest."""
    to_world: Similarity
    """Where the armature object stands; that of the object itself with `Placement.CHARACTER`."""
    rests: tuple[FootRest, ...]
    """Rests of the planted feet."""
    soles: Mapping[str, Array]
    """(N, 3) by role of foot and toe: points of the sole at rest, in the armature's space."""
    size: float
    """The character's size: its legs' length over the performer's."""
    notes: tuple[str, ...] = ()
    """What a person should know, in sentences without a full stop."""
