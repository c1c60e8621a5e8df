"""Try a character's inverse kinematics: how hands and feet follow their goals, and where poles belong."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from scipy.spatial.transform import Rotation

from .....core.arrays import Array
from .....core.retarget.controls.control_channels import Control, ControlChannels, control_channels
from .....core.retarget.controls.control_plan import ControlKind, limb_bones
from .....core.retarget.controls.control_spaces import NOTHING
from .....core.retarget.controls.control_targets import SHORTEST_POLE, PoleSetting, pole_offset
from .....core.retarget.controls.rigid_offset import rigid_offset
from .....core.retarget.maps.character_map import CharacterMap
from .....core.text import Sentence
from .posing import Property, Value, read_poses, set_channels, set_properties

TRIALS = ((0.8, 0.0, (0.2, -0.1, 0.15)), (0.7, 0.5, (-0.15, 0.2, 0.1)))
"""Of each trial: distance of the limb's end from its root, in that at rest; turn of the pole about the line
between both [rad]; turn of hand or foot as a rotation vector [rad]."""
AGREE_RAD = 0.1
"""Largest difference of two readings of a pole's angle."""
FOLLOWS_RAD, FOLLOWS = 0.05, 0.01
"""Turn, and distance in sizes of the character, by which a hand or foot may fail to follow its goal."""


@dataclass(frozen=True, eq=False)
class TriedInverseKinematics:
    """What limbs do in IK."""

    offsets: Mapping[str, Array]
    """(4, 4) by goal or toe control the pose of its bone in its own axes."""
    poles: Mapping[str, PoleSetting]
    places: Mapping[str, Array]
    """(3,) by control its place in the axes of what turns it, of those that stay there."""
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Limb:
    """A limb with its goal, and its joints at rest."""

    name: str
    goal: Control
    pole: Control | None
    toe: Control | None
    bones: tuple[str, str, str]
    rest: Array
    """(3, 4, 4) the poses of the bones."""
    rest_pole: Array
    """(3,) the place of the pole; the joint's own where there is none."""


def try_inverse_kinematics(
    armature_object: bpy.types.Object,
    character_map: CharacterMap,
    controls: Sequence[Control],
    size: float,
    in_ik: Mapping[Property, Value],
) -> TriedInverseKinematics:
    """Pull hands and feet toward the body, and look; inside of `posing`.

    Args:
        armature_object: The character; its limbs show FK.
        character_map: Its map.
        controls: Its controls, those that turn or carry others first.
        size: The character's, in the armature's units.
        in_ik: The custom properties with which its limbs show IK.
    """
    if not any(control.plan.kind is ControlKind.GOAL for control in controls):
        return TriedInverseKinematics({}, {}, {}, ())
    names = [control.name for control in controls]
    set_channels(armature_object, {name: np.eye(4) for name in names})
    _, rest = read_poses(armature_object, names)
    at_rest = dict(zip(names, rest, strict=True))
    limbs = _limbs(armature_object, character_map, controls, at_rest)
    set_properties(armature_object, in_ik)
    seen = [_try(armature_object, controls, limbs, at_rest, size, *trial) for trial in TRIALS]
    offsets: dict[str, Array] = {}
    poles: dict[str, PoleSetting] = {}
    notes: list[str] = []
    poses = {name: np.array([one[name] for one in seen]) for name in seen[0]}
    for limb in limbs:
        for control in (limb.goal, limb.toe):
            if control is None:
                continue
            offset, turn_rad, distance = rigid_offset(poses[control.name], poses[control.plan.bone])
            if control is limb.goal and (turn_rad > FOLLOWS_RAD or distance > FOLLOWS * size):
                notes.append(
                    Sentence(
                        "Bone '{bone}' does not follow its goal '{control}' rigidly; its inverse kinematics "
                        "may be off",
                        bone=control.plan.bone,
                        control=control.name,
                    )
                )
                offset = np.linalg.inv(at_rest[control.name]) @ limb.rest[2]
            offsets[control.name] = offset
        if limb.pole is None:
            notes.append(
                Sentence(
                    "The inverse kinematics of {limb} has no pole that could be keyed; bone '{bone}' may "
                    "point elsewhere",
                    limb=limb.name,
                    bone=limb.bones[1],
                )
            )
        else:
            poles[limb.pole.name] = _pole_setting(limb, limb.pole.name, poses, notes)
    places = {}
    for control in controls:
        if control.space.turner != NOTHING:
            turner = controls[control.space.turner].name
            offset, _, distance = rigid_offset(poses[turner], poses[control.name])
            if distance < FOLLOWS * size:
                places[control.name] = offset[:3, 3]
    return TriedInverseKinematics(offsets, poles, places, tuple(notes))


def _limbs(
    armature_object: bpy.types.Object,
    character_map: CharacterMap,
    controls: Sequence[Control],
    at_rest: Mapping[str, Array],
) -> list[_Limb]:
    found = []
    for goal in controls:
        if goal.plan.kind is not ControlKind.GOAL:
            continue
        limb = str(goal.plan.limb)
        own = {control.plan.kind: control for control in controls if control.plan.limb == limb}
        pole, toe = own.get(ControlKind.POLE), own.get(ControlKind.TOE)
        bones = limb_bones(character_map, limb)
        _, rest = read_poses(armature_object, bones)
        rest_pole = rest[1, :3, 3] if pole is None else at_rest[pole.name][:3, 3]
        found.append(_Limb(limb, goal, pole, toe, bones, rest, rest_pole))
    return found


def _try(
    armature_object: bpy.types.Object,
    controls: Sequence[Control],
    limbs: Sequence[_Limb],
    at_rest: Mapping[str, Array],
    size: float,
    reach: float,
    pole_turn_rad: float,
    turn: tuple[float, float, float],
) -> dict[str, Array]:
    """Poses (4, 4) of controls and of the limbs' bones in one trial."""
    wanted = {name: pose[None] for name, pose in at_rest.items()}
    for limb in limbs:
        root, end = limb.rest[0, :3, 3], limb.rest[2, :3, 3]
        pose = limb.rest[2].copy()
        pose[:3, :3] = Rotation.from_rotvec(turn).as_matrix() @ pose[:3, :3]
        pose[:3, 3] = root + reach * (end - root)
        wanted[limb.goal.name] = (
            pose @ np.linalg.inv(np.linalg.inv(at_rest[limb.goal.name]) @ limb.rest[2])
        )[None]
        if limb.pole is not None:
            pole = np.eye(4)
            pole[:3, 3] = _tried_pole(limb, pole_turn_rad)
            wanted[limb.pole.name] = pole[None]
    found = control_channels(controls, wanted, size)
    moved = {
        control.name: _matrix(channels)
        for control, channels in zip(controls, found, strict=True)
        if control.plan.kind in (ControlKind.GOAL, ControlKind.POLE)
    }
    set_channels(armature_object, moved)
    names = [control.name for control in controls]
    names += [name for limb in limbs for name in limb.bones]
    names += [limb.toe.plan.bone for limb in limbs if limb.toe is not None]
    _, poses = read_poses(armature_object, names)
    return dict(zip(names, poses, strict=True))


def _matrix(channels: ControlChannels) -> Array:
    matrix = np.eye(4)
    if channels.rotation is not None:
        matrix[:3, :3] = channels.rotation[0]
    if channels.location is not None:
        matrix[:3, 3] = channels.location[0]
    return matrix


def _tried_pole(limb: _Limb, turn_rad: float) -> Array:
    """(3,) a place for the pole beside the limb: its own at rest, turned about the limb's line."""
    root, end = limb.rest[0, :3, 3], limb.rest[2, :3, 3]
    axis = (end - root) / np.linalg.norm(end - root)
    along = ((limb.rest_pole - root) @ axis) * axis
    across = limb.rest_pole - root - along
    if np.linalg.norm(across) < SHORTEST_POLE * np.linalg.norm(end - root):
        across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        across *= np.linalg.norm(end - root) / np.linalg.norm(across)
    return root + along + Rotation.from_rotvec(turn_rad * axis).as_matrix() @ across


def _pole_setting(limb: _Limb, name: str, poses: Mapping[str, Array], notes: list[str]) -> PoleSetting:
    """Where the pole belongs; a sentence is added where it steers nothing."""
    root, middle, end = (poses[bone][:, :3, 3] for bone in limb.bones)
    pole = poses[name][:, :3, 3]
    offsets = np.array([pole_offset(*points) for points in zip(root, middle, end, pole, strict=True)])
    mean = float(np.angle(np.exp(1j * offsets).mean()))
    if np.abs(np.angle(np.exp(1j * (offsets - mean)))).max() > AGREE_RAD:
        notes.append(
            Sentence(
                "Pole '{pole}' does not steer bone '{bone}'; in IK it may point elsewhere",
                pole=name,
                bone=limb.bones[1],
            )
        )
    rest = limb.rest[:, :3, 3]
    length = float(np.linalg.norm(rest[1] - rest[0]) + np.linalg.norm(rest[2] - rest[1]))
    distance = float(np.linalg.norm(limb.rest_pole - rest[1]))
    return PoleSetting(distance if distance > SHORTEST_POLE * length else 0.5 * length, mean)
