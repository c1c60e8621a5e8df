"""The figure held upright: places of its bones across, behind and above, both sides taken together."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...arrays import Array, BoolArray
from .bones import Bones
from .symmetry import Symmetry

LEVEL = 0.2
"""Largest cosine between an axis that may point up and the way from side to side."""
SIDED = 0.004
"""Share of the size by which a bone's branch lies on a side."""


@dataclass(frozen=True, eq=False)
class Frame:
    """Bones with their symmetry and the direction that is taken for up."""

    bones: Bones
    symmetry: Symmetry
    up: Array
    """(3,) unit vector at right angles to the symmetry's normal."""

    @cached_property
    def behind(self) -> Array:
        """(3,) the horizontal direction in the plane; whether it points ahead or back is not known yet."""
        return np.cross(self.symmetry.normal, self.up)

    @cached_property
    def place(self) -> Array:
        """(N, 3) heads in sizes: distance from the plane, along `behind`, and up; means of both sides."""
        return self.coordinates(self.symmetric_heads)

    @cached_property
    def symmetric_heads(self) -> Array:
        """(N, 3) means of each head and its counterpart's mirror image, in the armature's space."""
        return symmetric(self.bones.head, self.symmetry)

    @cached_property
    def ends(self) -> Array:
        """(N, 3) tails in the coordinates of `place`; NaN where tails say nothing."""
        return self.coordinates(symmetric(self.bones.tail, self.symmetry))

    @cached_property
    def branch(self) -> tuple[Array, ...]:
        """(K, 3) places of each bone with all below it, tails included."""
        both = np.stack([self.place, self.ends])
        found = []
        for below in self.bones.subtree:
            points = both[:, list(below)].reshape(-1, 3)
            found.append(points[np.isfinite(points[:, 0])])
        return tuple(found)

    @cached_property
    def floor(self) -> float:
        """Height of the lowest bone that may be anatomy, in sizes."""
        anatomy = [not reading.mechanism for reading in self.bones.readings]
        heights = self.place[anatomy, 2] if any(anatomy) else self.place[:, 2]
        return float(heights.min())

    @cached_property
    def one_side(self) -> BoolArray:
        """(N,) bones of one side, one of each pair."""
        partner = self.symmetry.partner
        found = np.zeros(len(partner), dtype=bool)
        for bone in np.flatnonzero((partner >= 0) & (partner > np.arange(len(partner)))):
            other = int(partner[bone])
            centers = [self.symmetry.lateral(self.bones.points[each]).mean() for each in (bone, other)]
            found[bone if centers[0] >= centers[1] else other] = True
        return found

    @cached_property
    def middle(self) -> BoolArray:
        """(N,) bones of the middle."""
        return self.symmetry.partner == np.arange(len(self.symmetry.partner))

    def coordinates(self, points: Array) -> Array:
        """Points (..., 3) in sizes: distance from the plane, along `behind`, and up."""
        across = np.abs(self.symmetry.lateral(points))
        return np.stack([across, points @ self.behind, points @ self.up], axis=-1) / self.bones.size


def symmetric(points: Array, symmetry: Symmetry) -> Array:
    """(N, 3) means of each bone's point and the mirror image of its counterpart's."""
    partner = symmetry.partner
    paired = partner >= 0
    images = symmetry.mirrored(points[np.where(paired, partner, 0)])
    return np.where(paired[:, None], 0.5 * (points + images), points)


def frames(bones: Bones, symmetry: Symmetry) -> list[Frame]:
    """Frames for each direction that may be up: the axes of the armature's space that lie in the plane."""
    found = []
    for axis in np.eye(3)[[2, 1, 0]]:
        if abs(float(axis @ symmetry.normal)) < LEVEL:
            up = axis - symmetry.normal * float(axis @ symmetry.normal)
            up /= np.linalg.norm(up)
            found += [Frame(bones, symmetry, sign * up) for sign in (1.0, -1.0)]
    return found
