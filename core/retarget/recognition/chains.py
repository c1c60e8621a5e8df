"""Chains of three bones on one side, which may be a leg or an arm."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array, IndexArray
from .bones import Bones
from .frame import Frame

LONGEST_CHAIN = 16
"""Bones upward from a limb's end among which its other bones are sought."""
SHORT_END = 1.2
"""What hangs on the last bone of an arm without a hand reaches no farther than this many upper arms."""
SHORTEST_LIMB = 0.08
"""Shortest limb, in sizes."""


@dataclass(frozen=True, eq=False)
class Chains:
    """C chains of three bones, each above the next, on one side."""

    bones: IndexArray
    """(C, 3) upper, middle and end bone; the end is -1 where the middle is a limb's last bone."""
    attached: IndexArray
    """(C,) bone of the middle on which each hangs; -1 for none."""

    def __len__(self) -> int:
        return len(self.bones)

    def taken(self, which: IndexArray) -> "Chains":
        """Some of them."""
        return Chains(self.bones[which], self.attached[which])


def find_chains(frame: Frame) -> Chains:
    """All chains of one side that are long enough for a limb."""
    bones, side = frame.bones, frame.one_side
    found: list[tuple[int, int, int]] = []
    attached: list[int] = []
    for end in np.flatnonzero(side):
        above, hangs_on = _line(bones, frame, int(end))
        for second, middle in enumerate(above):
            for upper in above[second + 1 :]:
                found.append((upper, middle, int(end)))
                attached.append(hangs_on)
        both = int(end), int(frame.symmetry.partner[end])
        reach = min(float(np.max(_length(frame.branch[each] - frame.place[each]))) for each in both)
        for upper in above:  # a limb may lack its hand
            if reach < SHORT_END * float(_length(frame.place[int(end)] - frame.place[upper])):
                found.append((upper, int(end), -1))
                attached.append(hangs_on)
    table = np.array(found, dtype=np.intp).reshape(-1, 3)
    chains = Chains(table, np.array(attached, dtype=np.intp))
    places = frame.place
    ends = np.where(table[:, 2] >= 0, table[:, 2], table[:, 1])
    length = _length(places[table[:, 1]] - places[table[:, 0]]) + _length(places[ends] - places[table[:, 1]])
    return chains.taken(np.flatnonzero(length > SHORTEST_LIMB))


def _line(bones: Bones, frame: Frame, end: int) -> tuple[list[int], int]:
    """Bones above an end on its side, the nearest first, and the bone of the middle they hang on."""
    line: list[int] = []
    for above in bones.ancestors(end):
        if frame.middle[above]:
            return line, above
        if frame.symmetry.partner[above] < 0 or len(line) == LONGEST_CHAIN:
            break
        line.append(above)
    return line, -1


def _length(vectors: Array) -> Array:
    return np.asarray(np.linalg.norm(vectors, axis=-1))
