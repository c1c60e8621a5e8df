"""The bones that may play a role, in a tree of anatomy: joined where parents run through helper bones."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...arrays import Array, BoolArray, IndexArray
from ..character import Character
from .names import NameReading, read_name

SAME_PLACE = 0.003
"""Points closer than this share of the figure's size lie at one place."""
NEAR_PLACE = 0.03
"""Two bones that should meet and are closer than this meet, though somebody moved them."""
LARGEST_END = 0.2
"""A foot or a hand with all below it reaches no farther than this, in sizes."""
UNEVEN = 3.0
"""Neighboring bones of a limb differ in length by no more than this factor."""
MEETING_TAILS = 0.5
"""Least share of bones whose tail meets a child's head where tails say something."""
ONWARD = 0.6
"""Least cosine between a limb's last bone and the way to a bone that continues it."""
LONGEST_BONE = 0.4
"""Longest way, in sizes, from a chain's last head to a bone that continues it."""


@dataclass(frozen=True, eq=False)
class Bones:
    """N candidate bones in their tree of anatomy, parents before children."""

    number: IndexArray
    """(N,) index of each in the character's bones."""
    names: tuple[str, ...]
    head: Array
    """(N, 3) in the armature's space."""
    tail: Array
    """(N, 3); NaN where tails say nothing."""
    parent: IndexArray
    """(N,) its parent in the tree of anatomy, by place in this table; -1 for none."""
    deforms: BoolArray
    """(N,)."""
    size: float
    """Largest extent of the heads."""

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
    def roots(self) -> tuple[int, ...]:
        """Bones without a parent."""
        return tuple(int(bone) for bone in np.flatnonzero(self.parent < 0))

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
        found = []
        for below in self.subtree:
            places = np.concatenate([self.head[list(below)], self.tail[list(below)]])
            found.append(places[np.isfinite(places[:, 0])])
        return tuple(found)

    def ancestors(self, bone: int) -> list[int]:
        """Parents upward, the nearest first."""
        found = []
        while (bone := int(self.parent[bone])) >= 0:
            found.append(bone)
        return found


def candidate_bones(character: Character) -> Iterator[Bones]:
    """Yield tables of bones to look for roles in, the most likely first.

    Where some bones move a mesh and others do not, those that do come first; all bones come after them.
    """
    everything = np.arange(len(character.bones))
    deforming = _deforming(character)
    if 0 < len(deforming) < len(everything):
        yield anatomy(character, deforming)
    yield anatomy(character, everything)


def anatomy(character: Character, number: IndexArray) -> Bones:
    """Some of a character's bones in their tree of anatomy."""
    heads = np.array([bone.head for bone in character.bones])
    tails = np.array([bone.tail for bone in character.bones])
    size = float(np.max(np.ptp(heads[number], axis=0)))
    parent = _nearest_parents(character, number, heads, tails, size)
    telling = tails_tell(character, size)
    tail = tails[number] if telling else np.full((len(number), 3), np.nan)
    head = heads[number]
    readings = [read_name(character.bones[index].name) for index in number]
    parent = _joined_roots(head, tail, parent, size)
    parent = _joined_ends(head, tail, parent, readings, size)
    order = _parents_first(parent)
    place = np.empty(len(order), dtype=np.intp)
    place[order] = np.arange(len(order))
    above = parent[order]
    return Bones(
        number[order],
        tuple(character.bones[index].name for index in number[order]),
        head[order],
        tail[order],
        np.where(above >= 0, place[above], -1),
        np.array([character.bones[index].deforms for index in number[order]], dtype=bool),
        size,
    )


def tails_tell(character: Character, size: float) -> bool:
    """Whether tails lie where the next bone begins, as they do not after many imports."""
    met = counted = 0
    for bone, children in zip(character.bones, character.children, strict=True):
        if children:
            ways = [np.linalg.norm(character.bones[child].head - bone.tail) for child in children]
            met += bool(min(ways) < 2 * SAME_PLACE * size)
            counted += 1
    return counted > 0 and met >= MEETING_TAILS * counted


def _deforming(character: Character) -> IndexArray:
    """Bones that move a mesh, and those without a twin among them on which several such hang."""
    deforms = np.array([bone.deforms for bone in character.bones])
    heads = np.array([bone.head for bone in character.bones])
    near = SAME_PLACE * float(np.max(np.ptp(heads, axis=0)))
    hubs = []
    for number, children in enumerate(character.children):
        carried = sum(bool(deforms[child]) for child in children)
        if not deforms[number] and carried >= 2:
            twins = np.linalg.norm(heads[deforms] - heads[number], axis=1) < near
            if not twins.any() and not read_name(character.bones[number].name).mechanism:
                hubs.append(number)
    return np.array(sorted([*np.flatnonzero(deforms), *hubs]), dtype=np.intp)


def _nearest_parents(
    character: Character, number: IndexArray, heads: Array, tails: Array, size: float
) -> IndexArray:
    """(N,) nearest ancestor in the table, or the bone of the table that lies where an ancestor lies.

    A bone that hangs on nothing, as constraints alone may carry it, has the ancestors of a bone that lies
    where it does and is not in the table.
    """
    place = {int(index): row for row, index in enumerate(number)}
    found = np.full(len(number), -1, dtype=np.intp)
    if len(number) == len(character.bones):
        return np.array([place.get(character.bones[index].parent, -1) for index in number], dtype=np.intp)
    outside = np.setdiff1d(np.arange(len(character.bones)), number)
    for row, index in enumerate(number):
        starts = [int(index)]
        if character.bones[index].parent < 0:
            starts += [int(twin) for twin in _twins(int(index), int(index), outside, heads, tails, size)]
        ways = []
        for start in starts:
            above, steps = character.bones[start].parent, 0
            while above >= 0:
                twins = (above,) if above in place else _twins(above, int(index), number, heads, tails, size)
                if len(twins) and (above in place or not _is_above(character, int(index), int(twins[0]))):
                    ways.append((steps, place[int(twins[0])]))
                    break
                above, steps = character.bones[above].parent, steps + 1
        found[row] = min(ways)[1] if ways else -1
    return _without_circles(found)


def _twins(bone: int, child: int, number: IndexArray, heads: Array, tails: Array, size: float) -> IndexArray:
    """The bones of a table that lie where `bone` does, head and tail, the nearest first."""
    apart = np.linalg.norm(heads[number] - heads[bone], axis=1)
    ends = np.linalg.norm(tails[number] - tails[bone], axis=1)
    there = (apart < SAME_PLACE * size) & (ends < 10 * SAME_PLACE * size) & (number != child)
    return number[there][np.argsort((apart + 0.01 * ends)[there], kind="stable")]


def _is_above(character: Character, bone: int, other: int) -> bool:
    """Whether `bone` is `other` or an ancestor of it."""
    while other >= 0:
        if other == bone:
            return True
        other = character.bones[other].parent
    return False


def _without_circles(parent: IndexArray) -> IndexArray:
    """The parents, with a bone that would be its own ancestor made a root."""
    parent = parent.copy()
    for bone in range(len(parent)):
        seen = {bone}
        above = int(parent[bone])
        while above >= 0:
            if above in seen:
                parent[bone] = -1
                break
            seen.add(above)
            above = int(parent[above])
    return parent


def _joined_roots(head: Array, tail: Array, parent: IndexArray, size: float) -> IndexArray:
    """Roots but the largest tree's joined to the bone on whose end their head lies."""
    parent = parent.copy()
    top, count = _tops(parent)
    roots = np.flatnonzero(parent < 0)
    main = roots[np.argmax(count[roots])]
    for root in roots:
        if root == main:
            continue
        ends = np.linalg.norm(tail - head[root], axis=1)
        ends[top == root] = np.inf
        taken = np.linalg.norm(head - head[root], axis=1) < SAME_PLACE * size
        taken[top == root] = False
        best = int(np.nanargmin(ends)) if np.isfinite(ends).any() else -1
        if best >= 0 and ends[best] < SAME_PLACE * size and not taken.any():
            parent[root] = best
            top, count = _tops(parent)
    return parent


def _joined_ends(
    head: Array, tail: Array, parent: IndexArray, readings: Sequence[NameReading], size: float
) -> IndexArray:
    """Feet and hands that hang on the root or a control joined to the limb whose end they lie at."""
    parent = parent.copy()
    for bone in range(len(parent)):
        above = int(parent[bone])
        if readings[bone].mechanism or above < 0:
            continue
        own = _below(parent, bone)
        reach = float(np.max(np.linalg.norm(head[own] - head[bone], axis=1)))
        if (
            reach < LARGEST_END * size
            and _is_hub(above, head, parent, size)
            and not _meets(tail, head, above, bone, size)
        ):
            onto = _limb_ending_at(bone, own, head, tail, parent, readings, size)
            if onto is not None:
                parent[bone] = onto
    return parent


def _is_hub(bone: int, head: Array, parent: IndexArray, size: float) -> bool:
    """Whether a bone is a root, stands where its root does, or carries half of all bones."""
    top = bone
    while parent[top] >= 0:
        top = int(parent[top])
    at_root = np.linalg.norm(head[bone] - head[top]) < NEAR_PLACE * size
    return bool(at_root or 2 * _below(parent, bone).sum() >= len(parent))


def _meets(tail: Array, head: Array, first: int, second: int, size: float) -> bool:
    """Whether a bone begins or ends where another begins."""
    ends = np.linalg.norm(np.stack([head[first], tail[first]]) - head[second], axis=1)
    return bool((ends < NEAR_PLACE * size).any())


def _limb_ending_at(
    bone: int,
    own: BoolArray,
    head: Array,
    tail: Array,
    parent: IndexArray,
    readings: Sequence[NameReading],
    size: float,
) -> int | None:
    """The last bone of a limb that a bone continues; None where there is none, or another continues it."""
    above = parent[bone]
    other = np.array([reading.other for reading in readings])
    has_child = np.bincount(parent[(parent >= 0) & ~other], minlength=len(parent)) > 0
    way = np.linalg.norm(head - head[bone], axis=1)
    side = readings[bone].side
    limb = ~own & (parent >= 0)
    limb &= np.where(parent >= 0, parent[np.maximum(parent, 0)] >= 0, False)
    limb &= np.array([not side or reading.side in (side, None) for reading in readings])
    limb &= np.array([not reading.mechanism for reading in readings])
    limb[above] = False
    ends = np.flatnonzero(limb & ~has_child & (way < NEAR_PLACE * size))
    for end in ends[np.argsort(way[ends], kind="stable")]:  # the limb's end may be a bone of its own
        plays = readings[end].clear_part
        continues = readings[bone].clear_part is not None or readings[end].other or own.sum() > 1
        if parent[end] != above and not plays and continues:
            return int(parent[end])
    limb &= ~other
    taken = limb & (way < SAME_PLACE * size)
    if taken.any():
        return None
    gap = np.linalg.norm(tail - head[bone], axis=1)
    if np.isfinite(gap).any():
        meeting = np.flatnonzero(limb & (gap < NEAR_PLACE * size))
        return int(meeting[np.argmax(way[meeting])]) if len(meeting) else None
    onward = [
        end
        for end in np.flatnonzero(limb & ~has_child & (way < LONGEST_BONE * size) & (way > NEAR_PLACE * size))
        if _continues(int(end), bone, head, parent)
    ]
    return int(min(onward, key=lambda end: way[end])) if onward else None


def _continues(end: int, bone: int, head: Array, parent: IndexArray) -> bool:
    """Whether a bone lies in the direction in which a chain's last bone came, about as far."""
    came, goes = head[end] - head[parent[end]], head[bone] - head[end]
    lengths = float(np.linalg.norm(came)), float(np.linalg.norm(goes))
    if min(lengths) * UNEVEN < max(lengths):
        return False
    return float(came @ goes) > ONWARD * lengths[0] * lengths[1]


def _tops(parent: IndexArray) -> tuple[IndexArray, IndexArray]:
    """(N,) root of each bone, and (N,) number of bones of the tree at each root."""
    top = np.arange(len(parent))
    for _ in range(len(parent)):
        above = np.where(parent[top] >= 0, parent[top], top)
        if np.array_equal(above, top):
            break
        top = above
    return top, np.bincount(top, minlength=len(parent))


def _below(parent: IndexArray, bone: int) -> BoolArray:
    """(N,) whether each is `bone` or below it."""
    own = np.zeros(len(parent), dtype=bool)
    own[bone] = True
    for _ in range(len(parent)):
        grown = own | np.where(parent >= 0, own[parent], False)
        if np.array_equal(grown, own):
            break
        own = grown
    return own


def _parents_first(parent: IndexArray) -> IndexArray:
    """(N,) an order with parents before children, otherwise as given."""
    depth = np.zeros(len(parent), dtype=np.intp)
    for bone in range(len(parent)):
        above, steps = int(parent[bone]), 0
        while above >= 0 and steps <= len(parent):
            above, steps = int(parent[above]), steps + 1
        depth[bone] = steps
    return np.argsort(depth, kind="stable")
