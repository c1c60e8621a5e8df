"""Roles of a character's bones: the parts of a body that they play.

A role of a side ends in `.L` or `.R`, the character's own left and right.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from ..arrays import Array
from ..body.skeleton import FINGERS, SIDES

MIDDLE = ("hips", "spine", "neck", "head")
TRUNK_CHAINS = ("spine", "neck")  # roles that several bones may share, from the hips upward
ARM = ("shoulder", "upper_arm", "forearm", "hand")
LEG = ("thigh", "shin", "foot", "toe")
HANDS = {side: tuple(f"{finger}.{side}" for finger in FINGERS) for side in SIDES}
"""Roles of each hand's fingers, which have up to three bones from the knuckle on."""
FINGER_ROLES = (*HANDS["L"], *HANDS["R"])
CHAINS = (*TRUNK_CHAINS, *FINGER_ROLES)
ROLES = (*MIDDLE, *(f"{part}.{side}" for side in SIDES for part in (*ARM, *LEG)), *FINGER_ROLES)
"""All roles, the trunk's first."""
REQUIRED = (
    "hips",
    *(f"{part}.{side}" for side in SIDES for part in ("upper_arm", "forearm", "thigh", "shin", "foot")),
)
"""Roles without which an armature is no character; all others may be missing."""
LIMBS = {
    f"{limb}.{side}": tuple(f"{part}.{side}" for part in parts)
    for limb, parts in (("arm", ARM), ("leg", LEG))
    for side in SIDES
}
"""The roles of `arm.L`, `leg.L`, `arm.R` and `leg.R`, from the trunk outward."""
SOURCES = ("preset", "names", "shape", "you")  # a convention, the names, the places, or the person
JOINTS = {limb: roles[1:] if limb.startswith("arm") else roles[:3] for limb, roles in LIMBS.items()}
"""The roles that begin at a limb's three joints: upper arm, forearm and hand, or thigh, shin and foot."""
LONG_BONES = {limb: tuple(pairwise(roles)) for limb, roles in JOINTS.items()}
"""By limb the roles at both ends of its two long bones."""


# --- Where an armature is, and its bones at rest, as arrays


@dataclass(frozen=True, eq=False)
class Similarity:
    """From an armature's space to the world: turn, place and one scale."""

    rotation: Array  # (3, 3)
    location: Array  # (3,) [m]
    scale: float

    @property
    def matrix(self) -> Array:
        """(4, 4)."""
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = self.scale * self.rotation, self.location
        return matrix

    def to_world(self, points: Array) -> Array:
        """World coordinates (..., 3) of points in the armature's space [m]."""
        return np.asarray(self.location + self.scale * (points @ self.rotation.T))

    def from_world(self, points: Array) -> Array:
        """The inverse of `to_world`."""
        return np.asarray((points - self.location) @ self.rotation / self.scale)


@dataclass(frozen=True, eq=False)
class CharacterBone:
    """A bone at rest."""

    name: str
    parent: int  # index of its parent; -1 for none
    rest: Array  # (4, 4) in the armature's space and units: the axes as columns, then the head
    tail: Array  # (3,) in the armature's space; importers may put it anywhere, the head is what counts
    deforms: bool = True  # whether it moves a mesh
    connected: bool = False  # whether it begins at its parent's tail: Blender ignores its location

    @property
    def head(self) -> Array:
        """(3,) in the armature's space."""
        return np.asarray(self.rest[:3, 3])


@dataclass(frozen=True, eq=False)
class Character:
    """An armature's rest pose."""

    name: str  # name of the object, for sentences
    bones: tuple[CharacterBone, ...]  # parents before their children
    scale: float = 1.0  # meters a unit of the armature's space: the object's one positive scale

    @cached_property
    def index(self) -> dict[str, int]:
        """Index of each bone by its name."""
        return {bone.name: number for number, bone in enumerate(self.bones)}

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Indices of each bone's children."""
        found: list[list[int]] = [[] for _ in self.bones]
        for number, bone in enumerate(self.bones):
            if bone.parent >= 0:
                found[bone.parent].append(number)
        return tuple(tuple(each) for each in found)

    @cached_property
    def tails_are_meant(self) -> bool:
        """Whether most bones end at a child's head, so that the tails of the others mean something too."""
        near = 0.006 * float(np.max(np.ptp([bone.head for bone in self.bones], axis=0)))
        met = [
            min(float(np.linalg.norm(bone.tail - self.bones[child].head)) for child in children) < near
            for bone, children in zip(self.bones, self.children, strict=True)
            if children
        ]
        return bool(met) and float(np.mean(met)) >= 0.5

    def ancestors(self, bone: int) -> list[int]:
        """Indices of a bone's parents upward, the nearest first."""
        found = []
        while (bone := self.bones[bone].parent) >= 0:
            found.append(bone)
        return found

    def bone(self, name: str) -> CharacterBone:
        """The bone called `name`; KeyError where there is none."""
        return self.bones[self.index[name]]
