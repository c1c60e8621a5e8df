"""A motion as the character performs it: the poses of the bones that play a role, before any control."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from ..arrays import Array, BoolArray


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
    """Height of the ground there, along the character's up from the armature's origin [m]."""


@dataclass(frozen=True, eq=False)
class HandGoal:
    """Where a hand of the character belongs by what the performer's hand is near."""

    place_m: Array
    """(F, 3) place of the wrist, canonical, before any way is taken off [m]."""
    share: Array
    """(F,) how much it counts against the direction of the arm, 0 to 1."""
    floor_share: Array
    """(F,) how much the floor counts in it, 0 to 1."""
    in_reach: BoolArray
    """(F,) whether the arm reaches it without being stretched."""


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
    stance: Array = field(default_factory=lambda: np.eye(3))
    """(3, 3) from the armature's axes to canonical ones: Z up, facing -Y. *Canonical* places are in these
    axes and in meters, from the armature's origin."""
    facing: Array = field(default_factory=lambda: np.eye(3))
    """(3, 3) from directions of the performer's world to the character's; 1 with `Placement.PERFORMER`."""
    way_m: Array = field(default_factory=lambda: np.zeros(3))
    """(F, 3) or (3,) way over the ground that `RootMotion.IN_PLACE` took off, canonical [m]."""
    ground_m: Mapping[str, Array] = field(default_factory=lambda: MappingProxyType({}))
    """(F,) by limb of each planted foot: height of the ground under it, canonical [m]."""
    hands: Mapping[str, HandGoal] = field(default_factory=lambda: MappingProxyType({}))
    """Where hands belong, by side, of those that reach."""
    notes: tuple[str, ...] = ()
    """What a person should know, in sentences without a full stop."""
