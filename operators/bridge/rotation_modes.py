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
    angles = np.linalg.norm(vectors, axis=-1)
    turned = angles >= SMALL_TURN
    axes = np.concatenate([[[0.0, 1.0, 0.0]], vectors / np.where(turned, angles, 1.0)[:, None]])
    # Where it hardly turns, the axis stays the last one; before the first turn it is Y, as of new bones.
    rows = np.maximum.accumulate(np.where(turned, 1 + np.arange(len(angles)), 0))
    axes = axes[np.concatenate([[0], rows])]
    # The opposite axis and angle are the same rotation; where they lie nearer, they are taken.
    signs = np.cumprod(np.where(np.sum(axes[1:] * axes[:-1], axis=-1) < 0.0, -1.0, 1.0))
    unwrapped = np.unwrap(signs * np.where(turned, angles, 0.0))
    return np.concatenate([unwrapped[:, None], signs[:, None] * axes[1:]], axis=-1)


def _continuous_eulers(rotation: Array, order: str) -> Array:
    # Blender's XYZ turns about the fixed x first, then y, then z: scipy's lower case.
    angles = Rotation.from_matrix(rotation).as_euler(order.lower())
    # The second triple is the same rotation; it is the nearer one after passing the pole.
    triples = np.stack([angles, angles * [1.0, -1.0, 1.0] + np.pi])
    steps = triples[None, :, 1:] - triples[:, None, :-1]
    ways = np.abs(steps - 2.0 * np.pi * np.round(steps / (2.0 * np.pi))).sum(axis=-1)  # (from, to, F - 1)
    passes = ways[:, 1] < ways[:, 0]
    chosen = np.zeros(len(angles), dtype=np.intp)
    for frame, found in enumerate(passes.T.tolist()):
        chosen[frame + 1] = found[chosen[frame]]
    values = np.empty((len(angles), 3))
    columns = ["XYZ".index(axis) for axis in order]
    values[:, columns] = np.unwrap(triples[chosen, np.arange(len(angles))], axis=0)
    return values
