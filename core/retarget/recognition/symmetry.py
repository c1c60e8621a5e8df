"""The plane between a character's two sides, and which bones are each other's mirror images."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Array, IndexArray
from .bones import Bones

SAME = 0.02
"""A mirrored head lies this near to its counterpart, in sizes."""
BESIDE = 0.02
"""A head farther from the plane than this, in sizes, is on a side."""
LOOSE = 0.12
"""Two branches may mirror each other although their heads are this far, in sizes, from doing so."""
MOST_SYMMETRIES = 3
"""Planes that are yielded."""
WORSE = 0.5
"""Share of the heads that a plane may mirror less than the best one."""
ALIKE = 0.98
"""Cosine between normals of planes from which they are taken for one."""
MOST_PLANES = 60
"""Planes that are tried."""
MOST_POINTS = 200
"""Heads that a plane is tried on."""
BRANCH_POINTS = 32
"""Points of a branch that are compared with another's."""


@dataclass(frozen=True, eq=False)
class Symmetry:
    """The plane n·p = offset, and the bones' counterparts."""

    normal: Array
    """(3,) unit vector from one side to the other."""
    offset: float
    partner: IndexArray
    """(N,) counterpart of each bone on the other side; itself in the middle; -1 where there is none."""

    def lateral(self, points: Array) -> Array:
        """Signed distances (...) of points (..., 3) from the plane."""
        return points @ self.normal - self.offset

    def mirrored(self, points: Array) -> Array:
        """Mirror images of points (..., 3)."""
        return _mirrored(points, self.normal, self.offset)


def find_symmetries(bones: Bones) -> Iterator[Symmetry]:
    """Yield planes that mirror many bones onto others, the one that mirrors most first.

    A body in a T pose is nearly flat, so that one in a skirt may have its front and back mirrored as well.
    """
    named = _named_pairs(bones)
    planes = _planes(bones, named)
    sample = bones.head[:: max(1, len(bones.names) // MOST_POINTS)]
    tree = cKDTree(bones.head)
    planes += [_fitted(bones, tree, *plane) for plane in planes]
    scores = [_score(sample, tree, normal, offset, bones.size) for normal, offset in planes]
    taken: list[Array] = []
    for index in sorted(range(len(planes)), key=lambda index: -scores[index]):
        normal, offset = planes[index]
        if len(taken) == MOST_SYMMETRIES or scores[index] < max(scores) - WORSE * len(sample):
            return
        if any(abs(float(normal @ other)) > ALIKE for other in taken):
            continue
        for _ in range(2):
            partner = _partners(bones, normal, offset, named)
            normal, offset = _refined(bones, partner, normal, offset)
        taken.append(planes[index][0])
        yield Symmetry(normal, offset, partner)


def _named_pairs(bones: Bones) -> dict[int, int]:
    """Bones whose names differ in the side alone, by each other."""
    sides: dict[tuple[str, str], list[int]] = {}
    for bone, reading in enumerate(bones.readings):
        if reading.side is not None:
            sides.setdefault((reading.unsided.casefold(), reading.side), []).append(bone)
    found = {}
    for (unsided, side), those in sides.items():
        others = sides.get((unsided, "R"), [])
        if side == "L" and len(those) == len(others) == 1:
            found[those[0]], found[others[0]] = others[0], those[0]
    return found


def _planes(bones: Bones, named: dict[int, int]) -> list[tuple[Array, float]]:
    """Planes between branches that may be each other's counterparts, different ones only."""
    weighted: list[tuple[float, Array, Array]] = []
    pairs = [(bone, other) for bone, other in named.items() if bones.readings[bone].side == "L"]
    if pairs:
        left, right = (bones.head[list(side)] for side in zip(*pairs, strict=True))
        apart = np.median(left - right, axis=0)
        weighted.append((np.inf, apart, 0.5 * np.median(left + right, axis=0)))
    centers = np.array([points.mean(axis=0) for points in bones.points])
    for siblings in (bones.roots, *bones.children):
        those = [bone for bone in siblings if len(siblings) <= 60 or len(bones.subtree[bone]) > 2]
        for first, a in enumerate(those):
            for b in those[first + 1 :]:
                small, large = sorted((len(bones.subtree[a]), len(bones.subtree[b])))
                apart = centers[a] - centers[b]
                if small >= 0.6 * large and np.linalg.norm(apart) > BESIDE * bones.size:
                    weight = small * float(np.linalg.norm(apart))
                    weighted.append((weight, apart, 0.5 * (centers[a] + centers[b])))
    weighted.sort(key=lambda plane: -plane[0])
    return _different(weighted, bones.size)


def _different(weighted: Sequence[tuple[float, Array, Array]], size: float) -> list[tuple[Array, float]]:
    found: list[tuple[Array, float]] = []
    for _, apart, middle in weighted:
        length = float(np.linalg.norm(apart))
        if length < 1e-9 * size:
            continue
        normal = apart / length
        offset = float(normal @ middle)
        for other, other_offset in found:
            cosine = float(normal @ other)
            if abs(cosine) > 0.9995 and abs(offset * np.sign(cosine) - other_offset) < 0.005 * size:
                break
        else:
            found.append((normal, offset))
            if len(found) == MOST_PLANES:
                break
    return found


def _score(points: Array, tree: cKDTree, normal: Array, offset: float, size: float) -> float:
    """How many points beside a plane have a counterpart, and how few have none."""
    beside = np.abs(points @ normal - offset) > BESIDE * size
    images = _mirrored(points[beside], normal, offset)
    if not len(images):
        return -np.inf
    apart, _ = tree.query(images, distance_upper_bound=SAME * size)
    near = np.where(np.isfinite(apart), 1.0 - 0.5 * apart / (SAME * size), -0.5)
    return float(near.sum())


def _fitted(bones: Bones, tree: cKDTree, normal: Array, offset: float) -> tuple[Array, float]:
    """The plane between the heads that a plane nearly mirrors onto others."""
    images = _mirrored(bones.head, normal, offset)
    apart, other = tree.query(images, distance_upper_bound=2 * SAME * bones.size)
    paired = np.flatnonzero(np.isfinite(apart) & (other != np.arange(len(other))))
    return _between(bones.head[paired], bones.head[other[paired]], normal, offset, bones.size)


def _partners(bones: Bones, normal: Array, offset: float, named: dict[int, int]) -> IndexArray:
    """Counterparts by the tree: children of the middle among themselves, children of a pair between both."""
    partner = np.full(len(bones.names), -1, dtype=np.intp)
    _match(bones, list(bones.roots), normal, offset, named, partner)
    for bone in range(len(bones.names)):  # parents stand before children
        other = int(partner[bone])
        if other == bone:
            _match(bones, list(bones.children[bone]), normal, offset, named, partner)
        elif other > bone:
            both = [*bones.children[bone], *bones.children[other]]
            _match(bones, both, normal, offset, named, partner, across=len(bones.children[bone]))
        elif other < 0 and bone in named and partner[named[bone]] < 0:
            partner[bone], partner[named[bone]] = named[bone], bone
    return partner


def _match(
    bones: Bones,
    those: list[int],
    normal: Array,
    offset: float,
    named: dict[int, int],
    partner: IndexArray,
    across: int | None = None,
) -> None:
    """Find counterparts among some bones.

    Args:
        bones: The bones.
        those: Which of them.
        normal: (3,) of the plane.
        offset: Of the plane.
        named: Pairs by their names.
        partner: (N,) where what is found is noted.
        across: Where given, the first so many are of one side and the rest of the other.
    """
    if not those:
        return
    cost = _costs(bones, those, normal, offset)
    for a, bone in enumerate(those):
        if named.get(bone) in those:
            cost[a, those.index(named[bone])] -= 1.0
        side = bones.readings[bone].side
        for b, other in enumerate(those):
            if a != b and side and bones.readings[other].side == side:
                cost[a, b] += 1.0
    if across is not None:
        cost[:across, :across] = cost[across:, across:] = np.inf
    open_rows = set(range(len(those)))
    for flat in np.argsort(cost, axis=None, kind="stable"):
        a, b = divmod(int(flat), len(those))
        if not cost[a, b] < LOOSE:
            break
        if a in open_rows and b in open_rows:
            partner[those[a]], partner[those[b]] = those[b], those[a]
            open_rows -= {a, b}


def _costs(bones: Bones, those: list[int], normal: Array, offset: float) -> Array:
    """(K, K) how badly bones mirror each other, in sizes; on the diagonal how far each is from the middle."""
    heads = bones.head[those]
    apart = np.linalg.norm(heads[:, None] - _mirrored(heads, normal, offset)[None], axis=-1)
    cost = 0.5 * apart / bones.size
    branches = [_some(bones.points[bone]) for bone in those]
    images = [_mirrored(points, normal, offset) for points in branches]
    for a, points in enumerate(branches):
        for b, image in enumerate(images):
            if cost[a, b] < LOOSE:
                cost[a, b] += 0.5 * _apart(points, image) / bones.size
    count = np.array([len(bones.subtree[bone]) for bone in those], dtype=np.float64)
    cost += 0.02 * np.abs(np.log(count[:, None] / count[None]))
    cost[np.diag_indices(len(those))] += 0.005  # a pair close to the plane is a pair
    return cost


def _some(points: Array) -> Array:
    """At most `BRANCH_POINTS` of some points."""
    return points[:: -(-len(points) // BRANCH_POINTS)]


def _apart(points: Array, others: Array) -> float:
    """Median distance from the fewer points to the nearest of the others: one side may hold a weapon."""
    fewer, more = (points, others) if len(points) <= len(others) else (others, points)
    return float(np.median(np.linalg.norm(fewer[:, None] - more[None], axis=-1).min(axis=1)))


def _refined(bones: Bones, partner: IndexArray, normal: Array, offset: float) -> tuple[Array, float]:
    """The plane between all pairs, as they are."""
    pairs = np.flatnonzero(partner > np.arange(len(partner)))
    return _between(bones.head[pairs], bones.head[partner[pairs]], normal, offset, bones.size)


def _between(a: Array, b: Array, normal: Array, offset: float, size: float) -> tuple[Array, float]:
    """The plane between pairs of points (K, 3), near a given one; that itself where they do not tell."""
    apart = a - b
    apart *= np.where(apart @ normal < 0.0, -1.0, 1.0)[:, None]
    direction = apart.sum(axis=0)
    length = float(np.linalg.norm(direction))
    if length < 1e-6 * size:
        return normal, offset
    unit = direction / length
    axis = np.round(unit)
    if float(unit @ axis) > 0.9999 * float(np.linalg.norm(axis)) > 0.0:
        unit = axis / np.linalg.norm(axis)
    return unit, float(np.median(0.5 * (a + b) @ unit))


def _mirrored(points: Array, normal: Array, offset: float) -> Array:
    return np.asarray(points - 2.0 * (points @ normal - offset)[..., None] * normal)
