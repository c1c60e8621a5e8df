"""Rotations in the rotation mode of a bone, which the animator chooses and Keymark never changes."""

import bpy
import numpy as np
from scipy.spatial.transform import Rotation

from ...core.arrays import Array
from ...core.body.rotations import continuous_quaternions, to_quaternions

SMALL_TURN = 1e-7
"""Below this angle [rad] a rotation has no axis of its own and keeps the one before."""
PATHS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
ALL_PATHS = ("rotation_quaternion", "rotation_axis_angle", "rotation_euler")


def rotation_path(mode: str) -> str:
    """The property that holds the rotation in `mode`: one of ALL_PATHS."""
    return PATHS.get(mode, "rotation_euler")


def bone_path(bone: str, channel: str) -> str:
    """Data path of a pose bone's property."""
    return f'pose.bones["{bpy.utils.escape_identifier(bone)}"].{channel}'


def rotation_values(rotation: Array, mode: str) -> Array:
    """The values of the property `rotation_path(mode)` over time, without jumps.

    Args:
        rotation: (F, 3, 3) rotations relative to the bone's rest.
        mode: Blender's rotation mode: QUATERNION, AXIS_ANGLE, or the order of Euler angles such as XYZ.

    Returns:
        (F, 4) quaternion w, x, y, z or angle [rad] and axis x, y, z; or (F, 3) Euler angles x, y, z [rad].
    """
    if mode == "QUATERNION":
        return continuous_quaternions(to_quaternions(rotation))
    if mode == "AXIS_ANGLE":
        return _continuous_axis_angles(rotation)
    return _continuous_eulers(rotation, mode)


def set_rotation(pose_bone: bpy.types.PoseBone, rotation: Array) -> None:
    """Turn a pose bone to `rotation` (3, 3), relative to its rest, in the bone's own mode."""
    mode = pose_bone.rotation_mode
    setattr(pose_bone, rotation_path(mode), rotation_values(rotation[None], mode)[0])


def _continuous_axis_angles(rotation: Array) -> Array:
    vectors = Rotation.from_matrix(rotation).as_rotvec()
    values = np.zeros((len(vectors), 4))
    before = np.array([0.0, 0.0, 1.0, 0.0])
    for frame, vector in enumerate(vectors):
        angle = float(np.linalg.norm(vector))
        if angle < SMALL_TURN:
            axis, angle = before[1:], 0.0
        else:
            axis = vector / angle
            if axis @ before[1:] < 0.0:  # the opposite axis and angle are the same rotation and lie nearer
                axis, angle = -axis, -angle
        turns = np.round((before[0] - angle) / (2.0 * np.pi)) if frame else 0.0
        before = np.array([angle + 2.0 * np.pi * turns, *axis])
        values[frame] = before
    return values


def _continuous_eulers(rotation: Array, order: str) -> Array:
    # Blender's XYZ turns about the fixed x first, then y, then z: scipy's lower case.
    angles = Rotation.from_matrix(rotation).as_euler(order.lower())
    columns = ["XYZ".index(axis) for axis in order]
    values = np.zeros((len(angles), 3))
    before = np.zeros(3)
    for frame, (first, middle, last) in enumerate(angles):
        found = [
            candidate + 2.0 * np.pi * np.round((before - candidate) / (2.0 * np.pi)) if frame else candidate
            for candidate in (
                np.array([first, middle, last]),
                np.array([first + np.pi, np.pi - middle, last + np.pi]),
            )
        ]
        # The second triple is the same rotation; it is the nearer one after passing the pole.
        before = found[0] if not frame else min(found, key=lambda angle: float(np.abs(angle - before).sum()))
        values[frame, columns] = before
    return values
