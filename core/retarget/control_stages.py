"""In which order the keys of controls are found: first the body in FK, then what inverse kinematics follows.

The goals of limbs that have both are fitted to the very places that the FK keys lead to, so that switching
between them moves nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from .control_channels import Control
from .control_plan import ControlKind
from .control_spaces import NOTHING

IN_IK = (ControlKind.GOAL, ControlKind.TOE, ControlKind.POLE)


@dataclass(frozen=True)
class FollowingControls:
    """Controls of inverse kinematics that hang together, and what carries them all."""

    controls: tuple[int, ...]
    """Indices among all controls, rising."""
    carrier: int
    """Index of the control that carries and turns them; NOTHING for none."""


def control_stages(controls: Sequence[Control]) -> tuple[tuple[int, ...], tuple[FollowingControls, ...]]:
    """Indices of the body's controls, and the groups of those that follow.

    Args:
        controls: All controls, those that turn or carry others first.
    """
    later = [False] * len(controls)
    for index, control in enumerate(controls):
        above = (control.space.turner, control.space.carrier)
        later[index] = control.plan.kind in IN_IK or any(other != NOTHING and later[other] for other in above)
    group = _groups(controls, later)
    body = {index for index in range(len(controls)) if not later[index]}
    following = []
    for name in sorted(set(group.values())):
        members = tuple(index for index in group if group[index] == name)
        outside = {
            other
            for index in members
            for other in (controls[index].space.turner, controls[index].space.carrier)
            if other not in members
        }
        if len(outside) == 1:
            following.append(FollowingControls(members, outside.pop()))
        else:  # turned by one and carried by another: only the whole rig shows where they are
            body |= set(members)
    return tuple(sorted(body)), tuple(following)


def _groups(controls: Sequence[Control], later: Sequence[bool]) -> dict[int, int]:
    """For each control that follows the first of those that it hangs together with."""
    group: dict[int, int] = {}
    for index, control in enumerate(controls):
        if not later[index]:
            continue
        near = {group[other] for other in (control.space.turner, control.space.carrier) if other in group}
        group[index] = min(near, default=index)
        for other, name in group.items():
            if name in near:
                group[other] = group[index]
    return dict(sorted(group.items()))
