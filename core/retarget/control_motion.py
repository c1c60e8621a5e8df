"""A motion on a character's controls, and the points of the character that each of them moves."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..finish.hermite import Spline
from .control_channels import Control, ControlChannels
from .control_plan import ControlKind
from .held_points import HeldPoint

ChannelValues = Callable[[Array, str], Array]
"""From turns (F, 3, 3) and a rotation mode to the values (F, C) of its channels, without jumps."""

FOLLOWED = (ControlKind.FK, ControlKind.HIPS, ControlKind.GOAL, ControlKind.TOE)
"""Kinds of controls that a bone follows rigidly."""


@dataclass(frozen=True, eq=False)
class KeyedControl:
    """What is keyed on a control."""

    control: Control
    turns: bool
    """Whether its values begin with its rotation channels."""
    moves: bool
    """Whether they end with three of location."""
    values: Array | Spline
    """(F, C) on every frame, or few keys."""

    @property
    def channel_count(self) -> int:
        """Number of its channels, C."""
        held = self.values
        return int((held.values if isinstance(held, Spline) else held).shape[1])

    @property
    def key_count(self) -> int:
        """Number of keys on all its channels."""
        held = self.values
        return int((held.values if isinstance(held, Spline) else held).size)


@dataclass(frozen=True, eq=False)
class LimbPaths:
    """A limb that shows IK."""

    joints: tuple[Array, Array, Array]
    """(F, 3) its root, its elbow or knee and its end, in the armature's space and units."""
    root_control: int
    """Index of the control that carries its root."""
    root_place: Array
    """(3,) the root in that control's axes, in the armature's units."""
    in_fk: bool
    """Whether it is keyed in FK as well."""
    pole_distance: float
    """Distance of its pole from elbow or knee, in the armature's units."""


@dataclass(frozen=True, eq=False)
class ControlMotion:
    """A motion on a character's controls, by channels for every frame."""

    controls: tuple[Control, ...]
    """Those that turn or carry others first."""
    channels: tuple[ControlChannels, ...]
    wanted: Mapping[str, Array]
    """(F, 4, 4) by control the pose that it is to have, in the armature's space."""
    offsets: Mapping[str, Array]
    """(4, 4) by control the pose of its bone in its own axes."""
    points: tuple[HeldPoint, ...]
    limbs: Mapping[str, LimbPaths]
    """Limbs that show IK."""
    size: float
    """The character's, in the armature's units."""
    scale: float
    """Meters a unit of the armature's space."""

    def points_of(self, index: int) -> list[tuple[HeldPoint, Array]]:
        """The points that a control moves rigidly, with their places (3,) in its axes [m]."""
        control = self.controls[index]
        if control.plan.kind not in FOLLOWED:
            return []
        offset = self.offsets[control.name]
        return [
            (point, self.scale * (offset[:3, :3] @ point.place + offset[:3, 3]))
            for point in self.points
            if point.bone == control.plan.bone
        ]

    def fk_control(self, bone: str) -> int | None:
        """Index of the control that moves a bone in FK."""
        kinds = (ControlKind.FK, ControlKind.HIPS)
        found = (
            index
            for index, control in enumerate(self.controls)
            if control.plan.bone == bone and control.plan.kind in kinds
        )
        return next(found, None)


def channel_values(control: Control, keyed: ControlChannels, of: ChannelValues) -> Array:
    """(F, C) a control's rotation channels, followed by three of location, as far as they are keyed."""
    columns = [np.zeros((len(keyed.place), 0))]
    if keyed.rotation is not None:
        columns.append(of(keyed.rotation, control.mode))
    if keyed.location is not None:
        columns.append(keyed.location)
    return np.concatenate(columns, axis=1)


def keyed_controls(
    controls: Sequence[Control], channels: Sequence[ControlChannels], values: Sequence[Array | Spline]
) -> tuple[KeyedControl, ...]:
    """What is keyed on each control that has channels."""
    return tuple(
        KeyedControl(control, keyed.rotation is not None, keyed.location is not None, held)
        for control, keyed, held in zip(controls, channels, values, strict=True)
        if keyed.rotation is not None or keyed.location is not None
    )
