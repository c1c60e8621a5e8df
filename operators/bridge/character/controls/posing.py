"""Pose a character for a moment, and leave no trace: channels, custom properties and animation come back."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from .....core.arrays import Array
from ...object_space import evaluated
from ...scene_frames import showing_action

Property = tuple[str, str]
"""Name of a pose bone, and of one of its custom properties."""
Value = float | int | bool
OBJECT_CHANNELS = ("location", "rotation_quaternion", "rotation_axis_angle", "rotation_euler", "scale")


@contextmanager
def posing(
    armature_object: bpy.types.Object,
    properties: Sequence[Property] = (),
    action: bpy.types.Action | None = None,
) -> Iterator[None]:
    """Let a pose be changed, or an Action be shown; afterwards all is as it was, to the last bit.

    Args:
        armature_object: The character.
        properties: Custom properties that may be changed as well.
        action: The Action to show meanwhile; none by default.
    """
    had_data, data = armature_object.animation_data is not None, armature_object.animation_data_create()
    with_strips, bones = data.use_nla, armature_object.pose.bones
    values = {(bone, name): bones[bone][name] for bone, name in properties}
    channels = {name: tuple(getattr(armature_object, name)) for name in OBJECT_CHANNELS}
    try:
        with showing_action(armature_object, action):
            data.use_nla = False
            yield
    finally:
        for (bone, name), value in values.items():
            bones[bone][name] = value
        for name, channel in channels.items():
            setattr(armature_object, name, channel)
        data.use_nla = with_strips
        if not had_data:
            armature_object.animation_data_clear()
        armature_object.update_tag()
        evaluated(armature_object)


def set_properties(armature_object: bpy.types.Object, values: Mapping[Property, Value]) -> None:
    """Set custom properties of pose bones, each in the type that it has."""
    for (bone, name), value in values.items():
        held = armature_object.pose.bones[bone]
        held[name] = type(held[name])(value)
    armature_object.update_tag()  # what only drivers read is not evaluated again otherwise


def set_channels(armature_object: bpy.types.Object, channels: Mapping[str, Array]) -> None:
    """Pose bones by their own rotation and location (4, 4), in the rotation modes they have; scale is one."""
    for name, matrix in channels.items():
        armature_object.pose.bones[name].matrix_basis = Matrix(matrix)


def read_poses(armature_object: bpy.types.Object, names: Sequence[str]) -> tuple[Array, Array]:
    """The bones' own channels and their poses in the armature's space, as evaluated now: (N, 4, 4) each."""
    bones = evaluated(armature_object).pose.bones
    channels: list[Any] = [bones[name].matrix_basis for name in names]
    poses: list[Any] = [bones[name].matrix for name in names]
    return np.array(channels, dtype=np.float64), np.array(poses, dtype=np.float64)
