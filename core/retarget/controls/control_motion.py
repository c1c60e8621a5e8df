"""A motion on a character's controls, and the points of the character that each of them moves."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ...arrays import Array
from ...keys.hermite import Spline, values_of
from .control_channels import Control, ControlChannels
from .control_plan import IN_FK, ControlKind
from .point_tolerances import HeldPoint

ChannelValues = Callable[[Array, str], Array]
"""From turns (F, 3, 3) and a rotation mode to the values (F, C) of its channels, without jumps."""


@dataclass(frozen=True, eq=False)
class KeyedControl:
    """What is keyed on a control."""

    control: Control
    rotation: Array | Spline | None  # (F, C) on every frame, or few keys; None if not keyed
    location: Array | Spline | None  # (F, 3) those of its location

    @property
    def values(self) -> tuple[Array, ...]:
        """The values of all its keys."""
        return tuple(values_of(held) for held in (self.rotation, self.location) if held is not None)


@dataclass(frozen=True, eq=False)
class LimbPaths:
    """A limb of three joints."""

    bones: tuple[str, str, str]  # the bones that begin at them
    joints: tuple[Array, Array, Array]  # (F, 3) its root, elbow or knee, and end [units]
    root_control: int  # index of the control that carries its root; NOTHING for none
    root_place: Array  # (3,) the root in that control's axes, in the armature's units
    bend: Array  # (F, 3) unit vector from the line between root and end toward elbow or knee
    in_fk: bool  # whether it is keyed in FK
    in_ik: bool  # whether it is keyed in IK, and shows it
    pole_distance: float  # distance of its pole from elbow or knee, in the armature's units


@dataclass(frozen=True, eq=False)
class ControlMotion:
    """A motion on a character's controls, by channels for every frame."""

    controls: tuple[Control, ...]  # those that turn or carry others first
    channels: tuple[ControlChannels, ...]
    wanted: Mapping[str, Array]  # (F, 4, 4) by control the pose that it is to have, in the armature's space
    offsets: Mapping[str, Array]  # (4, 4) by control the pose of its bone in its own axes
    points: tuple[HeldPoint, ...]
    bones: Mapping[str, Array]  # (F, 4, 4) poses of the bones with roles, in the armature's space
    limbs: Mapping[str, LimbPaths]  # the limbs whose three joints are moved
    size: float  # the character's, in the armature's units
    scale: float  # meters a unit of the armature's space

    def points_of(self, index: int) -> list[tuple[HeldPoint, Array]]:
        """The points that a control moves rigidly, with their places (3,) in its axes [m]."""
        control = self.controls[index]
        if control.plan.kind not in (*IN_FK, ControlKind.GOAL, ControlKind.TOE):
            return []
        offset = self.offsets[control.name]
        return [
            (point, self.scale * (offset[:3, :3] @ point.place + offset[:3, 3]))
            for point in self.points
            if point.bone == control.plan.bone
        ]

    def joints_m(self, limb: str) -> tuple[Array, Array, Array]:
        """(F, 3) a limb's root, its elbow or knee, and its end [m]."""
        root, middle, end = (self.scale * path for path in self.limbs[limb].joints)
        return root, middle, end

    def fk_control(self, bone: str) -> int | None:
        """Index of the control that moves a bone in FK."""
        plans = enumerate(control.plan for control in self.controls)
        return next((index for index, plan in plans if plan.bone == bone and plan.kind in IN_FK), None)


def dense_controls(motion: ControlMotion, of: ChannelValues) -> tuple[KeyedControl, ...]:
    """The motion with keys on every frame."""
    return tuple(
        KeyedControl(
            control, None if keyed.rotation is None else of(keyed.rotation, control.mode), keyed.location
        )
        for control, keyed in zip(motion.controls, motion.channels, strict=True)
    )
