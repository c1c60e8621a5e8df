"""In which order the keys of controls are found: the body, then its legs in FK, then what follows in IK.

Legs are fitted to the body that its few keys show, so that a resting foot rests however smooth the hips have
become. Goals of limbs that have both are fitted to the very places that the FK keys lead to, so that
switching between them moves nothing.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from .control_channels import Control
from .control_plan import ControlKind
from .control_spaces import NOTHING

IN_IK = (ControlKind.GOAL, ControlKind.TOE, ControlKind.POLE)


@dataclass(frozen=True)
class FollowingControls:
    """Controls that hang together and are fitted after what carries them."""

    controls: tuple[int, ...]
    """Indices among all controls, rising."""
    carrier: int
    """Index of the control that carries and turns them; NOTHING for none."""
    leg: str | None = None
    """The leg that they are in FK."""


@dataclass(frozen=True)
class ControlStages:
    """The controls in the order of their fitting."""

    body: tuple[int, ...]
    """Indices of the controls that are fitted first, rising."""
    following: tuple[FollowingControls, ...]
    """The others."""


def control_stages(
    controls: Sequence[Control], legs: Mapping[str, tuple[int, Collection[int]]]
) -> ControlStages:
    """The controls in the order of their fitting."""
    later = [False] * len(controls)
    for index, control in enumerate(controls):
        above = _above(control)
        later[index] = control.plan.kind in IN_IK or any(other != NOTHING and later[other] for other in above)
    chains = []
    for leg, (carrier, members) in legs.items():
        others = [index for index in range(len(controls)) if index not in members and not later[index]]
        carries = any(_above(controls[index]) & set(members) for index in others)
        if _outside(controls, members) == {carrier} and not carries:
            chains.append(FollowingControls(tuple(sorted(members)), carrier, leg))
    apart = {index for chain in chains for index in chain.controls}
    body = {index for index in range(len(controls)) if not later[index]} - apart
    group = _groups(controls, [late and index not in apart for index, late in enumerate(later)])
    for name in sorted(set(group.values())):
        members = tuple(index for index in group if group[index] == name)
        outside = _outside(controls, members)
        if len(outside) == 1:
            chains.append(FollowingControls(members, outside.pop()))
        else:  # turned by one and carried by another: only the whole rig shows where they are
            body |= set(members)
    return ControlStages(tuple(sorted(body)), tuple(chains))


def _above(control: Control) -> set[int]:
    return {control.space.turner, control.space.carrier}


def _outside(controls: Sequence[Control], members: Collection[int]) -> set[int]:
    """What turns and carries some controls and is none of them."""
    return {other for index in members for other in _above(controls[index]) if other not in members}


def _groups(controls: Sequence[Control], later: Sequence[bool]) -> dict[int, int]:
    """For each control that follows the first of those that it hangs together with."""
    group: dict[int, int] = {}
    for index, control in enumerate(controls):
        if not later[index]:
            continue
        near = {group[other] for other in _above(control) if other in group}
        group[index] = min(near, default=index)
        for other, name in group.items():
            if name in near:
                group[other] = group[index]
    return dict(sorted(group.items()))
