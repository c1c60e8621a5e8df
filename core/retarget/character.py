"""A character's bones at rest, as arrays: what recognition and solving see of an armature."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array


@dataclass(frozen=True, eq=False)
class CharacterBone:
    """A bone at rest."""

    name: str
    parent: int
    """Index of its parent; -1 for none."""
    rest: Array
    """(4, 4) rest matrix in the armature's own space and units: the axes as columns, then the head."""
    tail: Array
    """(3,) in the armature's space; importers may put it anywhere, the head is what counts."""
    deforms: bool = True
    """Whether it moves a mesh."""
    connected: bool = False
    """Whether its head is bound to its parent's tail, so that Blender ignores its location."""

    @property
    def head(self) -> Array:
        """(3,) in the armature's space."""
        return np.asarray(self.rest[:3, 3])


@dataclass(frozen=True, eq=False)
class Character:
    """An armature's rest pose."""

    name: str
    """Name of the object, for sentences."""
    bones: tuple[CharacterBone, ...]
    """Parents before their children."""
    scale: float = 1.0
    """Meters a unit of the armature's space: the object's one positive scale."""

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

    def bone(self, name: str) -> CharacterBone:
        """The bone called `name`; KeyError where there is none."""
        return self.bones[self.index[name]]
