"""Data paths of custom properties of pose bones."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import bpy
import numpy as np
from bpy.types import Action, Constraint, FCurve, Object, PoseBone

from ....core.arrays import Array
from ....core.retarget.maps.character_map import CharacterMap, Switch
from ..object_space import evaluated
from ..scene_frames import CHANNELS, showing_action


def property_path(bone: str, name: str) -> str:
    """Data path of a pose bone's custom property."""
    bone, name = bpy.utils.escape_identifier(bone), bpy.utils.escape_identifier(name)
    return f'pose.bones["{bone}"]["{name}"]'


Property = tuple[str, str]  # name of a pose bone, and of one of its custom properties
Value = float | int | bool


@contextmanager
def posing(
    armature_object: Object, properties: Sequence[Property] = (), action: Action | None = None
) -> Iterator[None]:
    """Let a pose and properties be changed, or an Action be shown; afterwards all is as before."""
    had_data, data = armature_object.animation_data is not None, armature_object.animation_data_create()
    with_strips, bones = data.use_nla, armature_object.pose.bones
    values = {(bone, name): bones[bone][name] for bone, name in properties}
    channels = {name: tuple(getattr(armature_object, name)) for name in CHANNELS}
    influences = [(each, each.influence) for bone in bones for each in bone.constraints]
    try:
        with showing_action(armature_object, action):
            data.use_nla = False
            yield
    finally:
        for (bone, name), value in values.items():
            bones[bone][name] = value
        for name, channel in channels.items():
            setattr(armature_object, name, channel)
        for constraint, influence in influences:
            if constraint.influence != influence:
                constraint.influence = influence
        data.use_nla = with_strips
        if not had_data:
            armature_object.animation_data_clear()
        armature_object.update_tag()
        evaluated(armature_object)


def set_properties(armature_object: Object, values: Mapping[Property, Value]) -> None:
    """Set custom properties of pose bones, each in the type that it has."""
    for (bone, name), value in values.items():
        held = armature_object.pose.bones[bone]
        held[name] = type(held[name])(value)
    armature_object.update_tag()  # what only drivers read is not evaluated again otherwise


def read_poses(armature_object: Object, names: Sequence[str]) -> tuple[Array, Array]:
    """The bones' own channels and their poses in the armature's space, as evaluated now: (N, 4, 4) each."""
    bones = evaluated(armature_object).pose.bones
    channels: list[Any] = [bones[name].matrix_basis for name in names]
    poses: list[Any] = [bones[name].matrix for name in names]
    return np.array(channels, dtype=np.float64), np.array(poses, dtype=np.float64)


def switch_values(
    character_map: CharacterMap, value: Callable[[str, Switch], Value | None]
) -> dict[Property, Value]:
    """The switches' values by limb and switch; those without one are left out."""
    switches = [(limb, own.switch) for limb, own in character_map.ik.items() if own.switch is not None]
    values = {(one.bone, one.property): value(limb, one) for limb, one in switches}
    return {key: found for key, found in values.items() if found is not None}


def keyed_values(character_map: CharacterMap, value: Callable[[str, Switch], Value]) -> dict[Property, Value]:
    """The settings, and the switches' values by limb and switch."""
    settings = {(one.bone, one.property): one.value for one in character_map.settings}
    return settings | switch_values(character_map, value)


BONE_PATH = re.compile(r'^pose\.bones\["((?:[^"\\]|\\.)*)"\]')
CONSTRAINT_PATH = re.compile(BONE_PATH.pattern + r'\.constraints\["((?:[^"\\]|\\.)*)"\]')
CARRYING = ("CHILD_OF", "ARMATURE")  # constraints that carry a bone as a parent does: its channels count


def active_constraints(bone: PoseBone) -> list[Constraint]:
    """The constraints of a bone that move it, or may do so once their influence is driven."""
    valid = [constraint for constraint in bone.constraints if constraint.is_valid]
    acting = [one for one in valid if one.influence > 0.0 and not one.mute]
    if len(acting) == len(valid):
        return valid
    paths = [CONSTRAINT_PATH.match(driver.data_path) for driver in drivers(bone.id_data)]
    driven = {tuple(map(bpy.utils.unescape_identifier, path.groups())) for path in paths if path}
    return [one for one in valid if one in acting or (bone.name, one.name) in driven]


def constraint_targets(constraint: Constraint) -> list[tuple[Object | None, str]]:
    """The objects that a constraint looks at, with names of their bones or of none."""
    targets = constraint.targets if constraint.type == "ARMATURE" else [constraint]
    return [(getattr(one, "target", None), getattr(one, "subtarget", "")) for one in targets]


def drivers(armature_object: Object) -> list[FCurve]:
    """The drivers of an armature object that work."""
    data = armature_object.animation_data
    return [] if data is None else [curve for curve in data.drivers if not curve.mute]
