"""Where an armature object stands, as channels that an Action may hold."""

import bpy
import numpy as np

from ....core.arrays import Array
from ....core.errors import InputError
from ....core.retarget.character_motion import Similarity
from ..object_space import evaluated
from ..rotation_modes import rotation_path, rotation_values

PlacementKeys = tuple[tuple[str, Array], ...]
"""Data paths of the object's channels with their values."""
CHANNELS = ("location", "rotation_quaternion", "rotation_axis_angle", "rotation_euler")


def placement_keys(armature_object: bpy.types.Object, to_world: Similarity) -> PlacementKeys:
    """The object's location and rotation, in its own rotation mode, with which it stands somewhere.

    Args:
        armature_object: The object, with any parent; its scale stays.
        to_world: From its own space to the world.
    """
    world = np.eye(4)
    world[:3, :3], world[:3, 3] = to_world.rotation, to_world.location
    basis = np.linalg.inv(_around(armature_object)) @ world
    turn = basis[:3, :3] / np.linalg.norm(basis[:3, :3], axis=0)
    mode = armature_object.rotation_mode
    delta = _delta_rotation(armature_object)
    location = basis[:3, 3] - np.array(armature_object.delta_location)
    return (("location", location), (rotation_path(mode), rotation_values((delta.T @ turn)[None], mode)[0]))


def _around(armature_object: bpy.types.Object) -> Array:
    """(4, 4) what the object's own transform is multiplied with: parents."""
    shown = evaluated(armature_object)
    world = np.array(shown.matrix_world, dtype=np.float64)
    return world @ np.linalg.inv(np.array(shown.matrix_basis, dtype=np.float64))


def _delta_rotation(armature_object: bpy.types.Object) -> Array:
    if armature_object.rotation_mode == "AXIS_ANGLE":  # has a delta of its own, which nobody can set
        return np.eye(3)
    if armature_object.rotation_mode == "QUATERNION":
        delta = armature_object.delta_rotation_quaternion
    else:
        delta = armature_object.delta_rotation_euler.to_quaternion()
    return np.array(delta.normalized().to_matrix(), dtype=np.float64)


def require_placeable(armature_object: bpy.types.Object) -> None:
    """Raise InputError where constraints or drivers decide where an object stands."""
    name = armature_object.name
    working = [one.name for one in armature_object.constraints if not one.mute and one.influence > 0.0]
    if working:
        raise InputError(
            f"armature '{name}' stands where its constraint '{working[0]}' puts it; mute it, or let the "
            "motion begin where the character stands"
        )
    data = armature_object.animation_data
    driven = (
        [] if data is None else [one for one in data.drivers if one.data_path in CHANNELS and not one.mute]
    )
    if driven:
        raise InputError(
            f"armature '{name}' has a driver on '{driven[0].data_path}', which wins over keys; mute it, "
            "or let the motion begin where the character stands"
        )
