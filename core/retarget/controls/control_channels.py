"""Channels of controls from the poses they are to have: each in the space of what turns and carries it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from ...arrays import Array
from .control_plan import ControlKind, PlannedControl
from .control_spaces import NOTHING, RIGID, ControlSpace, unscaled

ALWAYS_MOVED = (ControlKind.HIPS, ControlKind.GOAL, ControlKind.POLE, ControlKind.ROOT, ControlKind.CARRIER)
"""Kinds of controls that are placed wherever they can be."""


@dataclass(frozen=True, eq=False)
class Control:
    """A bone that is keyed, and how its channels act."""

    plan: PlannedControl
    mode: str  # its rotation mode
    space: ControlSpace  # its space; turner and carrier are indices among all controls
    turns: bool  # whether its rotation is keyed
    displaced: bool = False  # whether it has a location already, which a motion must replace

    @property
    def name(self) -> str:
        """The bone's name."""
        return self.plan.name


@dataclass(frozen=True, eq=False)
class ControlChannels:
    """A control over F frames."""

    rotation: Array | None  # (F, 3, 3) its rotation channels as a turn from rest; None for none
    location: Array | None  # (F, 3) its location channels; None where they are not keyed
    turn: Array  # (F, 3, 3) its axes in the armature's space, as the channels give them
    place: Array  # (F, 3) its head in the armature's space, as the channels give it


def ordered_controls(controls: Sequence[Control]) -> tuple[Control, ...]:
    """The controls in an order in which those that turn or carry others come before them.

    Where they would turn each other in a circle, which no rigid space does, one of them is taken as free.
    """
    order: list[int] = []

    def visit(index: int, above: frozenset[int]) -> None:
        if index == NOTHING or index in order or index in above:
            return
        space = controls[index].space
        for other in (space.turner, space.carrier):
            visit(other, above | {index})
        order.append(index)

    for index in range(len(controls)):
        visit(index, frozenset())
    place = {index: number for number, index in enumerate(order)} | {NOTHING: NOTHING}
    found = []
    for number, index in enumerate(order):
        space = controls[index].space
        turner, carrier = (
            above if above < number else NOTHING for above in (place[space.turner], place[space.carrier])
        )
        residual = space.residual if carrier == place[space.carrier] else np.inf
        space = replace(space, turner=turner, carrier=carrier, residual=residual)
        found.append(replace(controls[index], space=space))
    return tuple(found)


def control_channels(
    controls: Sequence[Control],
    wanted: Mapping[str, Array],
    size: float,
    known: Mapping[int, ControlChannels] = MappingProxyType({}),
) -> tuple[ControlChannels, ...]:
    """The channels that give controls the poses (F, 4, 4) they are to have, or the nearest that they can.

    Controls that turn or carry others come before them; channels in `known`, by index, stay. Poses are in the
    armature's space, the character's size in its units; of a pole only the place counts.
    """
    frames = len(next(iter(wanted.values()), np.zeros((1, 4, 4))))
    still, origin = np.broadcast_to(np.eye(3), (frames, 3, 3)), np.zeros((frames, 3))
    found: list[ControlChannels] = []
    for index, control in enumerate(controls):
        if index in known:
            found.append(known[index])
            continue
        space, pose = control.space, wanted[control.name]
        turner = still if space.turner == NOTHING else found[space.turner].turn
        axes, place = still, origin
        if space.carrier != NOTHING:
            axes, place = found[space.carrier].turn, found[space.carrier].place
        turn = turner @ space.turn
        rotation = None
        if control.turns:
            rotation = np.swapaxes(turn, -1, -2) @ unscaled(pose[:, :3, :3])
            turn = turn @ rotation
        place = place + axes @ space.origin
        goal = pose[:, :3, 3]
        for hips in controls if control.plan.kind in (ControlKind.ROOT, ControlKind.CARRIER) else ():
            held = hips.plan.kind is ControlKind.HIPS and hips.space.carrier == index
            if held and not hips.space.movable:  # it must place hips that cannot be placed themselves
                goal = wanted[hips.name][:, :3, 3] - turn @ hips.space.origin
        apart = goal - place
        location = None
        # Share of the character's size from which a bone that usually only turns is moved as well.
        must = control.displaced or np.linalg.norm(apart, axis=-1).max() > 0.005 * size
        if space.movable and (must or control.plan.kind in ALWAYS_MOVED):
            local = (np.swapaxes(axes, -1, -2) @ apart[..., None])[..., 0]
            location = np.linalg.solve(space.axes, local.T).T
        if location is not None or space.residual >= RIGID * size:  # where none can tell, as wanted
            place = goal
        found.append(ControlChannels(rotation, location, turn, place))
    return tuple(found)
