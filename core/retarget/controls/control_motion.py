"""A motion on a character's controls: the poses that they are to have, and the points that each moves."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...body import rotations
from ...keys.hermite import Spline, values_of
from ...numerics.vectors import unit
from ..character import JOINTS, LIMBS, Character
from ..character_motion import CharacterMotion
from ..maps.character_map import CharacterMap
from ..solve.two_bone import STRAIGHTEST, LimbPose, reach_for
from .control_channels import (
    IN_FK,
    NOTHING,
    Control,
    ControlChannels,
    ControlKind,
    control_channels,
    limb_bones,
)
from .point_tolerances import HeldPoint, held_points

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


SHORTEST_POLE = 0.25  # least distance of a pole from its joint, in lengths of the limb


@dataclass(frozen=True, eq=False)
class PoleSetting:
    """Where a pole belongs."""

    distance: float  # its distance from elbow or knee, in the armature's units
    offset_rad: float  # from its direction to that of elbow or knee, about the line from root to end


def on_controls(
    character: Character,
    character_map: CharacterMap,
    motion: CharacterMotion,
    controls: Sequence[Control],
    offsets: Mapping[str, Array],
    poles: Mapping[str, PoleSetting],
    size: float,
) -> ControlMotion:
    """A motion on a character's controls, by channels for every frame.

    `offsets` are the poses (4, 4) of bones in their controls' axes; `size` is in the armature's units.
    """
    wanted = {}
    frames = len(next(iter(motion.poses.values())))
    for plan in (control.plan for control in controls):
        if plan.kind is ControlKind.ROOT:
            if motion.root is not None:
                wanted[plan.name] = motion.root
        elif plan.kind is ControlKind.CARRIER:  # as at rest, wherever the hips need it
            wanted[plan.name] = np.broadcast_to(character.bone(plan.name).rest, (frames, 4, 4))
        elif plan.kind is ControlKind.POLE:
            limb = str(plan.limb)
            joints = [motion.poses[bone][:, :3, 3] for bone in limb_bones(character_map, limb)]
            wanted[plan.name] = pole_poses(joints, motion.bends[limb], poles[plan.name])
        else:
            wanted[plan.name] = motion.poses[plan.bone] @ np.linalg.inv(offsets[plan.name])
    return ControlMotion(
        controls=tuple(controls),
        channels=control_channels(controls, wanted, size),
        wanted=wanted,
        offsets=offsets,
        points=held_points(character, character_map, motion.soles),
        bones=motion.poses,
        limbs=_limb_paths(character, character_map, motion, controls, offsets, poles),
        size=size,
        scale=character.scale,
    )


def pole_poses(joints: Sequence[Array], bend: Array, setting: PoleSetting) -> Array:
    """(F, 4, 4) places of a pole, as matrices, from the joints (F, 3) of its limb and the way it bends.

    A pole without an offset lies beyond elbow or knee; others are as far from the line between the limb's
    root and its end.
    """
    root, middle, end = joints
    axis = unit(end - root)
    foot = root + np.sum((middle - root) * axis, axis=-1, keepdims=True) * axis
    out = np.linalg.norm(middle - foot, axis=-1, keepdims=True)
    turn = rotations.exponential(-setting.offset_rad * axis)
    poses = np.tile(np.eye(4), (len(bend), 1, 1))
    poses[:, :3, 3] = foot + (out + setting.distance) * (turn @ bend[..., None])[..., 0]
    return poses


def pole_offset(root: Array, middle: Array, end: Array, pole: Array) -> float:
    """Angle [rad] from a pole's direction to that of the elbow or knee it guides, about the limb's line."""
    axis = unit(end - root)
    toward = [point - root - ((point - root) @ axis) * axis for point in (pole, middle)]
    return float(np.arctan2(np.cross(toward[0], toward[1]) @ axis, toward[0] @ toward[1]))


def _limb_paths(
    character: Character,
    character_map: CharacterMap,
    motion: CharacterMotion,
    controls: Sequence[Control],
    offsets: Mapping[str, Array],
    poles: Mapping[str, PoleSetting],
) -> dict[str, LimbPaths]:
    found = {}
    in_ik = {control.plan.limb for control in controls if control.plan.kind is ControlKind.GOAL}
    fk = {
        one.plan.bone: index for index, one in reversed(list(enumerate(controls))) if one.plan.kind in IN_FK
    }
    for limb in LIMBS:
        bones = limb_bones(character_map, limb)
        if not set(JOINTS[limb]) <= set(character_map.roles) or not set(bones) <= set(motion.poses):
            continue
        # What carries its root: the nearest bone of the trunk, or the shoulder, that is keyed.
        above = (LIMBS[limb][0], "spine", "hips") if limb.startswith("arm") else ("hips",)
        names = (name for role in above for name in reversed(character_map.bones(role)) if name in fk)
        carrier, place = NOTHING, np.zeros(3)
        if (name := next(names, None)) is not None:
            carrier, rest = fk[name], character.bone(name).rest
            offset = offsets[controls[carrier].name]
            place = (character.bone(bones[0]).head - rest[:3, 3]) @ rest[:3, :3]
            place = np.asarray(offset[:3, :3] @ place + offset[:3, 3])
        root, middle, end = (motion.poses[bone][:, :3, 3] for bone in bones)
        pole = character_map.ik[limb].pole if limb in in_ik else None
        found[limb] = LimbPaths(
            bones,
            (root, middle, end),
            carrier,
            place,
            motion.bends[limb],
            set(bones) <= set(fk),
            limb in in_ik,
            poles[pole].distance if pole is not None else 0.0,
        )
    return found


def leg_on_body(motion: ControlMotion, leg: str, carrier: ControlChannels) -> dict[str, Array]:
    """(F, 4, 4) poses of the bones at a leg's joints on a body that few keys have moved a little."""
    limb = motion.limbs[leg]
    upper, lower, end = (motion.bones[bone].copy() for bone in limb.bones)
    start, middle, goal = limb.joints
    hinge = rotations.cross(limb.bend, unit(goal - start))
    before = LimbPose(upper[:, :3, :3], lower[:, :3, :3], start, middle, goal, hinge)
    root = carrier.place + (carrier.turn @ limb.root_place)
    after = reach_for(before, root, goal, STRAIGHTEST)
    upper[:, :3, :3], upper[:, :3, 3] = after.upper_turn, root
    lower[:, :3, :3], lower[:, :3, 3] = after.lower_turn, after.middle
    end[:, :3, 3] = after.end
    return dict(zip(limb.bones, (upper, lower, end), strict=True))
