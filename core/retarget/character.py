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
SOURCES = ("preset", "names", "shape", "you")
"""Where a role may come from: a convention's preset, the bones' names, their places, or the person."""
JOINTS = {limb: roles[1:] if limb.startswith("arm") else roles[:3] for limb, roles in LIMBS.items()}
"""The roles that begin at a limb's three joints: upper arm, forearm and hand, or thigh, shin and foot."""
LONG_BONES = {limb: tuple(pairwise(roles)) for limb, roles in JOINTS.items()}
"""By limb the roles at both ends of its two long bones."""


# --- A character's bones at rest, as arrays


@dataclass(frozen=True, eq=False)
class CharacterBone:
    """A bone at rest."""

    name: str
    parent: int  # index of its parent; -1 for none
    rest: Array
    """(4, 4) rest matrix in the armature's own space and units: the axes as columns, then the head."""
    tail: Array  # (3,) in the armature's space; importers may put it anywhere, the head is what counts
    deforms: bool = True  # whether it moves a mesh
    connected: bool = False
    """Whether its head is bound to its parent's tail, so that Blender ignores its location."""

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

    def ancestors(self, bone: int) -> list[int]:
        """Indices of a bone's parents upward, the nearest first."""
        found = []
        while (bone := self.bones[bone].parent) >= 0:
            found.append(bone)
        return found

    def bone(self, name: str) -> CharacterBone:
        """The bone called `name`; KeyError where there is none."""
        return self.bones[self.index[name]]
