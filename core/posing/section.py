"""The part of a clip around a corrected keyframe whose found keyframes are posed anew."""

from collections.abc import Collection
from dataclasses import dataclass, replace

from ..arrays import Array
from ..prior.keyframes import Keyframe
from ..take.take import Take

FARTHEST_S = 0.5
"""Time on either side of a corrected keyframe beyond which found ones stay: what a body does later
follows less and less from its posture there, and the animator waits."""


@dataclass(frozen=True)
class Section:
    """A part of a clip that is posed anew; all are indices of its frames."""

    first: int
    last: int
    changed: tuple[int, ...]
    """Found keyframes that are posed anew, in order."""


def section_around(time_s: Array, corrected: int, keyframes: Collection[Keyframe]) -> Section:
    """The part of a clip around a corrected keyframe that is posed anew.

    On either side it reaches to the next keyframe that the animator decided on, or else to the first found
    one beyond `FARTHEST_S`, or else to the clip's end; but always beyond one found keyframe, and nowhere
    without one.

    Args:
        time_s: (F,) times of the clip's frames [s].
        corrected: Index of the corrected keyframe.
        keyframes: All keyframes, those with `matched` found.
    """
    ends, changed = [], []
    for side, end in ((-1, 0), (1, len(time_s) - 1)):
        outward = sorted(
            (each for each in keyframes if side * (each.index - corrected) > 0),
            key=lambda each: abs(each.index - corrected),
        )
        near: list[int] = []
        for each in outward:
            far = abs(float(time_s[each.index] - time_s[corrected])) > FARTHEST_S
            if each.matched is None or (far and near):
                end = each.index
                break
            near.append(each.index)
        ends.append(end if near else corrected)
        changed += near
    return Section(ends[0], ends[1], tuple(sorted(changed)))


def take_around(take: Take, section: Section) -> Take:
    """The take with all keyframes that hold: decided ones, and found ones that bound the section."""
    kept = []
    for keyframe in take.keyframes:
        bounds = keyframe.index in (section.first, section.last) and keyframe.index not in section.changed
        if keyframe.matched is None or bounds:
            kept.append(replace(keyframe, matched=None))
    return replace(take, keyframes=tuple(kept))
