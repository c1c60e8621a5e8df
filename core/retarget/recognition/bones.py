"""The bones that may play a role, in a tree of anatomy: joined where parents run through helper bones."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...arrays import Array, BoolArray, IndexArray
from ..character import Character
from .names import NameReading, read_name

SAME_PLACE, NEAR_PLACE = 0.003, 0.03  # shares of the size within which points are one, and are meant to be


@dataclass(frozen=True, eq=False)
class Bones:
    """N candidate bones in their tree of anatomy, parents before children."""

    names: tuple[str, ...]
    head: Array  # (N, 3) in the armature's space
    tail: Array  # (N, 3); NaN where tails say nothing
    parent: IndexArray  # (N,) its parent in the tree of anatomy, by place in this table; -1 for none
    size: float  # largest extent of the heads

    @cached_property
    def readings(self) -> tuple[NameReading, ...]:
        """What each name says."""
        return tuple(read_name(name) for name in self.names)

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Children of each."""
        found: list[list[int]] = [[] for _ in self.names]
        for bone, parent in enumerate(self.parent):
            if parent >= 0:
                found[parent].append(bone)
        return tuple(tuple(each) for each in found)

    @cached_property
    def subtree(self) -> tuple[tuple[int, ...], ...]:
        """Each bone with all below it."""
        found: list[tuple[int, ...]] = [()] * len(self.names)
        for bone in reversed(range(len(self.names))):
            found[bone] = (bone, *(below for child in self.children[bone] for below in found[child]))
        return tuple(found)

    @cached_property
    def points(self) -> tuple[Array, ...]:
        """(K, 3) heads, and tails where they say something, of each bone with all below it."""
        both = np.stack([self.head, self.tail], axis=1)
        found = [both[list(below)].reshape(-1, 3) for below in self.subtree]
        return tuple(points[np.isfinite(points[:, 0])] for points in found)

    def ancestors(self, bone: int) -> list[int]:
        """Parents upward, the nearest first."""
        found = []
        while (bone := int(self.parent[bone])) >= 0:
            found.append(bone)
        return found


def candidate_bones(character: Character) -> Iterator[Bones]:
    """Yield tables of bones to look for roles in: those that move a mesh, where others do not, then all."""
    everything = np.arange(len(character.bones))
    deforming = np.flatnonzero([bone.deforms for bone in character.bones])
    if 0 < len(deforming) < len(everything):
        yield anatomy(character, deforming)
    yield anatomy(character, everything)


def anatomy(character: Character, number: IndexArray) -> Bones:
    """Some of a character's bones in their tree of anatomy."""
    heads, tails = (np.array([getattr(bone, end) for bone in character.bones]) for end in ("head", "tail"))
    size = float(np.max(np.ptp(heads[number], axis=0)))
    head = heads[number]
    tail = tails[number] if character.tails_are_meant else np.full(head.shape, np.nan)
    readings = [read_name(character.bones[index].name) for index in number]
    parent = _joined(head, tail, _nearest_parents(character, number, heads, tails, size), readings, size)
    depth = np.zeros(len(parent), dtype=np.intp)
    for bone in range(len(parent)):
        above, seen = int(parent[bone]), {bone}
        while above >= 0 and above not in seen:
            seen.add(above)
            above = int(parent[above])
        if above == bone:  # a circle is opened
            parent[bone] = -1
        depth[bone] = len(seen)
    order = np.argsort(depth, kind="stable")
    place = np.append(np.argsort(order), -1)
    names = tuple(character.bones[index].name for index in number[order])
    return Bones(names, head[order], tail[order], place[parent[order]], size)


def _nearest_parents(
    character: Character, number: IndexArray, heads: Array, tails: Array, size: float
) -> IndexArray:
    """(N,) nearest ancestor in the table, or the bone of the table that lies where an ancestor lies.

    A bone that hangs on nothing, as constraints alone may carry it, has the ancestors of a bone that lies
    where it does and is not in the table.
    """
    above = [bone.parent for bone in character.bones]
    row = {int(index): place for place, index in enumerate(number)}
    if len(row) == len(above):
        return np.array(above, dtype=np.intp)

    def twins(bone: int, table: IndexArray) -> list[int]:
        apart = np.linalg.norm(heads[table] - heads[bone], axis=1)
        ends = np.linalg.norm(tails[table] - tails[bone], axis=1)
        there = (apart < SAME_PLACE * size) & (ends < 10 * SAME_PLACE * size)
        return [int(twin) for twin in table[there][np.argsort(apart[there], kind="stable")]]

    outside = np.setdiff1d(np.arange(len(above)), number)
    parents = np.full(len(number), -1, dtype=np.intp)
    for index, place in row.items():
        ways = []
        for start in [index, *(twins(index, outside) if above[index] < 0 else [])]:
            for steps, bone in enumerate(character.ancestors(start)):
                here = (twin for twin in twins(bone, number) if twin != index)
                beside = [twin for twin in here if index not in character.ancestors(twin)]
                if bone in row or beside:
                    ways.append((steps, row[bone if bone in row else beside[0]]))
                    break
        parents[place] = min(ways, default=(0, -1))[1]
    return parents


def _joined(
    head: Array, tail: Array, parent: IndexArray, readings: Sequence[NameReading], size: float
) -> IndexArray:
    """The parents, with what hangs on nothing, and ends of limbs that hang on a root, joined to a limb."""
    parent = parent.copy()
    for bone in range(len(parent)):
        above, own = int(parent[bone]), _below(parent, bone)
        if 2 * own.sum() > len(parent) or readings[bone].mechanism:
            continue
        if above >= 0:
            reach = np.linalg.norm(head[own] - head[bone], axis=1).max()
            ends = np.linalg.norm(np.stack([head[above], tail[above]]) - head[bone], axis=1)
            hub = parent[above] < 0 or 2 * _below(parent, above).sum() >= len(parent)
            # A foot or a hand with all below it reaches no farther than this, in sizes.
            if reach > 0.2 * size or not hub or (ends < NEAR_PLACE * size).any():
                continue
        parent[bone] = _limb_before(bone, own, head, tail, parent, readings, size)
    return parent


def _limb_before(
    bone: int,
    own: BoolArray,
    head: Array,
    tail: Array,
    parent: IndexArray,
    readings: Sequence[NameReading],
    size: float,
) -> int:
    """The last bone of a limb that a bone continues; its parent where no limb waits for it."""
    above, side = int(parent[bone]), readings[bone].side
    way = np.linalg.norm(head - head[bone], axis=1)
    hangs = parent[np.maximum(parent, 0)] >= 0
    limb = ~own & np.array([not r.mechanism and (not side or r.side in (side, None)) for r in readings])
    other = np.array([reading.other for reading in readings])
    leaf = np.bincount(parent[(parent >= 0) & ~other], minlength=len(parent)) == 0
    ends = np.flatnonzero(limb & hangs & leaf & (way < NEAR_PLACE * size))
    for end in ends:  # the limb's end may be a bone of its own
        if (
            parent[end] not in (above, -1)
            and readings[end].clear_part is None
            and (own.sum() > 1 or other[end])
        ):
            return int(parent[end])
    if (limb & ~other & (way < SAME_PLACE * size) & (np.arange(len(way)) != above)).any():
        return above
    if np.isfinite(tail).all():
        gap = np.linalg.norm(tail - head[bone], axis=1)
        meeting = np.flatnonzero(limb & ~other & (gap < NEAR_PLACE * size) & (np.arange(len(way)) != above))
        if len(meeting) or above >= 0:
            return int(meeting[np.argmin(gap[meeting])]) if len(meeting) else above
    onward = []
    for end in np.flatnonzero(limb & hangs & leaf & ~other & (parent >= 0)):
        came, goes = head[end] - head[parent[end]], head[bone] - head[end]
        lengths = sorted((float(np.linalg.norm(came)), float(np.linalg.norm(goes))))
        # Least cosine between a limb's last bone and the way to a bone that continues it.
        # Neighboring bones of a limb differ in length by no more than this factor.
        if lengths[0] * 3.0 > lengths[1] and came @ goes > 0.6 * lengths[0] * lengths[1]:
            onward.append(int(end))
    return min(onward, key=lambda end: way[end], default=above)


def _below(parent: IndexArray, bone: int) -> BoolArray:
    """(N,) whether each is `bone` or below it."""
    own = np.zeros(len(parent), dtype=bool)
    own[bone] = True
    while True:
        grown = own | ((parent >= 0) & own[parent])
        if np.array_equal(grown, own):
            return own
        own = grown
