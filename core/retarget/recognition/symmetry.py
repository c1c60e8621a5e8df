"""The plane between a character's two sides, which bones mirror each other, and places seen from it."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Array, BoolArray, IndexArray
from .bones import Bones

SAME = 0.02  # sizes within which heads mirror each other, or lie in the plane


@dataclass(frozen=True, eq=False)
class Frame:
    """Bones with their plane of symmetry, n·p = offset, and the direction that is taken for up."""

    bones: Bones
    normal: Array  # (3,) unit vector from one side to the other
    offset: float
    partner: IndexArray  # (N,) bone on the other side; itself in the middle; -1 for none
    up: Array  # (3,) unit vector at right angles to the normal

    @cached_property
    def place(self) -> Array:
        """(N, 3) heads in sizes: distance from the plane, along normal × up, and up; means of both sides."""
        return self.coordinates(self.bones.head)

    @cached_property
    def ends(self) -> Array:
        """(N, 3) tails in the coordinates of `place`; NaN where tails say nothing."""
        return self.coordinates(self.bones.tail)

    @cached_property
    def branch(self) -> tuple[Array, ...]:
        """(K, 3) places of each bone with all below it, tails included."""
        both = np.stack([self.place, self.ends], axis=1)
        found = [both[list(below)].reshape(-1, 3) for below in self.bones.subtree]
        return tuple(points[np.isfinite(points[:, 0])] for points in found)

    @cached_property
    def one_side(self) -> BoolArray:
        """(N,) bones of one side, one of each pair."""
        across = np.array([float(np.mean(points @ self.normal)) for points in self.bones.points])
        paired = (self.partner >= 0) & ~self.middle
        ahead = across > across[self.partner]
        tie = (across == across[self.partner]) & (self.partner > np.arange(len(across)))
        return np.asarray(paired & (ahead | tie))

    @cached_property
    def middle(self) -> BoolArray:
        """(N,) bones of the middle."""
        return self.partner == np.arange(len(self.partner))

    def coordinates(self, points: Array) -> Array:
        """Points (N, 3) of the bones in the coordinates of `place`."""
        paired = self.partner >= 0
        images = mirrored(points[np.where(paired, self.partner, 0)], self.normal, self.offset)
        both = np.where(paired[:, None], 0.5 * (points + images), points)
        across = np.abs(both @ self.normal - self.offset)
        ahead = np.cross(self.normal, self.up)
        return np.stack([across, both @ ahead, both @ self.up], axis=-1) / self.bones.size


def find_frames(bones: Bones) -> Iterator[list[Frame]]:
    """Yield frames for each direction that may be up, plane by plane, the one that mirrors most first.

    A body in a T pose is nearly flat, so that one in a skirt may have its front and back mirrored as well.
    """
    for normal, offset, partner in find_planes(bones):
        found = []
        for axis in np.eye(3)[[2, 1, 0]]:
            # Largest cosine between an axis that may point up and the way from side to side.
            if abs(float(axis @ normal)) < 0.2:
                up = axis - normal * float(axis @ normal)
                up /= np.linalg.norm(up)
                found += [Frame(bones, normal, offset, partner, sign * up) for sign in (1.0, -1.0)]
        yield found


def find_planes(bones: Bones) -> Iterator[tuple[Array, float, IndexArray]]:
    """Yield normal, offset and partners (see `Frame`) of planes, the one that mirrors most bones first."""
    sides: dict[tuple[str, str], list[int]] = {}
    for bone, reading in enumerate(bones.readings):
        if reading.side is not None:
            sides.setdefault((reading.unsided.casefold(), reading.side), []).append(bone)
    named: dict[int, int] = {}  # bones whose names differ in the side alone, by each other
    for (unsided, side), those in sides.items():
        others = sides.get((unsided, "R"), [])
        if side == "L" and len(those) == len(others) == 1:
            named |= {those[0]: others[0], others[0]: those[0]}
    tree = cKDTree(bones.head)
    planes = [_fitted(bones, tree, *plane) for plane in _planes(bones, named)]
    planes.sort(key=lambda plane: -_score(bones, tree, *plane))
    taken: list[Array] = []
    for normal, offset in planes:
        # Cosine between normals of planes from which they are taken for one.
        if any(abs(float(normal @ other)) > 0.98 for other in taken):
            continue
        taken.append(normal)
        for _ in range(2):
            partner = _partners(bones, normal, offset, named)
            pairs = np.flatnonzero(partner > np.arange(len(partner)))
            normal, offset = _between(bones, pairs, partner[pairs], normal, offset)
        yield normal, offset, partner
        if len(taken) == 3:
            return


def _planes(bones: Bones, named: dict[int, int]) -> list[tuple[Array, float]]:
    """Planes between branches that may be each other's counterparts, different ones only."""
    weighted: list[tuple[float, Array, Array]] = []
    left = [bone for bone in named if bones.readings[bone].side == "L"]
    if left:
        heads, others = bones.head[left], bones.head[[named[bone] for bone in left]]
        weighted.append((np.inf, np.median(heads - others, axis=0), np.median(heads + others, axis=0)))
    centers = np.array([points.mean(axis=0) for points in bones.points])
    count = [len(below) for below in bones.subtree]
    roots = tuple(map(int, np.flatnonzero(bones.parent < 0)))
    for siblings in (roots, *bones.children):
        those = [bone for bone in siblings if len(siblings) <= 60 or count[bone] > 2]
        for first, a in enumerate(those):
            for b in those[first + 1 :]:
                small, large = sorted((count[a], count[b]))
                apart = centers[a] - centers[b]
                if small >= 0.6 * large:
                    weighted.append((small * float(np.linalg.norm(apart)), apart, centers[a] + centers[b]))
    found: list[tuple[Array, float]] = []
    for _, apart, both in sorted(weighted, key=lambda plane: -plane[0]):
        length = float(np.linalg.norm(apart))
        if len(found) == 60 or length < SAME * bones.size:
            continue
        normal = apart / length
        offset = 0.5 * float(normal @ both)
        if all(
            abs(cosine := float(normal @ other)) < 0.9995
            or abs(offset * np.sign(cosine) - other_offset) > 0.005 * bones.size
            for other, other_offset in found
        ):
            found.append((normal, offset))
    return found


def _score(bones: Bones, tree: cKDTree, normal: Array, offset: float) -> float:
    """How many heads beside a plane have a counterpart, and how few have none."""
    beside = np.abs(bones.head @ normal - offset) > SAME * bones.size
    images = mirrored(bones.head[beside], normal, offset)
    if not len(images):
        return -np.inf
    apart, _ = tree.query(images, distance_upper_bound=SAME * bones.size)
    return float(np.where(np.isfinite(apart), 1.0 - 0.5 * apart / (SAME * bones.size), -0.5).sum())


def _fitted(bones: Bones, tree: cKDTree, normal: Array, offset: float) -> tuple[Array, float]:
    """The plane between the heads that a plane nearly mirrors onto others."""
    images = mirrored(bones.head, normal, offset)
    apart, other = tree.query(images, distance_upper_bound=2 * SAME * bones.size)
    paired = np.flatnonzero(np.isfinite(apart) & (other != np.arange(len(other))))
    return _between(bones, paired, other[paired], normal, offset)


def _between(
    bones: Bones, first: IndexArray, second: IndexArray, normal: Array, offset: float
) -> tuple[Array, float]:
    """The plane between pairs of bones, near a given one; that itself where they do not tell."""
    a, b = bones.head[first], bones.head[second]
    apart = (a - b) * np.where((a - b) @ normal < 0.0, -1.0, 1.0)[:, None]
    direction = apart.sum(axis=0)
    length = float(np.linalg.norm(direction))
    if length < 1e-6 * bones.size:
        return normal, offset
    unit = direction / length
    axis = np.round(unit)
    if float(unit @ axis) > 0.9999 * float(np.linalg.norm(axis)) > 0.0:
        unit = axis / np.linalg.norm(axis)
    return unit, float(np.median(0.5 * (a + b) @ unit))


def _partners(bones: Bones, normal: Array, offset: float, named: dict[int, int]) -> IndexArray:
    """Counterparts by the tree: children of the middle among themselves, children of a pair between both."""
    # How badly bones mirror each other, in sizes; on the diagonal how far each is from the middle.
    middles = np.array([np.median(points, axis=0) for points in bones.points])
    cost = np.zeros((len(bones.names), len(bones.names)))
    for points in (bones.head, middles):
        images = mirrored(points, normal, offset)
        cost += 0.5 * np.linalg.norm(points[:, None] - images[None], axis=-1) / bones.size
    count = np.log([len(below) for below in bones.subtree])
    cost += 0.02 * np.abs(count[:, None] - count[None])
    sides = np.array([{"L": 1, "R": 2}.get(reading.side or "", 0) for reading in bones.readings])
    cost += (sides[:, None] == sides[None]) & (sides[:, None] > 0)
    cost[np.diag_indices(len(cost))] += 0.005 - (sides > 0)  # a pair close to the plane is a pair
    for bone, other in named.items():
        cost[bone, other] -= 1.0
    partner = np.full(len(bones.names), -1, dtype=np.intp)
    _match([int(bone) for bone in np.flatnonzero(bones.parent < 0)], None, cost, partner)
    for bone in range(len(bones.names)):  # parents stand before children
        other, children = int(partner[bone]), list(bones.children[bone])
        if other == bone:
            _match(children, None, cost, partner)
        elif other > bone:
            _match(children, list(bones.children[other]), cost, partner)
        elif other < 0 and bone in named and partner[named[bone]] < 0:
            partner[bone], partner[named[bone]] = named[bone], bone
    return partner


def _match(those: list[int], others: list[int] | None, cost: Array, partner: IndexArray) -> None:
    """Note counterparts among some bones, or between those and others, the nearest first."""
    rows, columns = np.array(those, dtype=np.intp), np.array(others or those, dtype=np.intp)
    if others is not None and not others:
        return
    part = cost[np.ix_(rows, columns)]
    for flat in np.argsort(part, axis=None, kind="stable"):
        a, b = (int(each) for each in np.unravel_index(flat, part.shape))
        # Two branches may mirror each other although they are this far, in sizes, from doing so.
        if not part[a, b] < 0.12:
            return
        if partner[rows[a]] < 0 and partner[columns[b]] < 0:
            partner[rows[a]], partner[columns[b]] = columns[b], rows[a]


def mirrored(points: Array, normal: Array, offset: float) -> Array:
    """Mirror images (..., 3) of points."""
    return np.asarray(points - 2.0 * (points @ normal - offset)[..., None] * normal)
