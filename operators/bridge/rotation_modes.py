"""Rotations in the mode of a bone, which the animator chooses, and postures fitted to joints' rotations."""

from collections.abc import Mapping

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body import rotations
from ...core.body.human import HUMAN
from ...core.body.posture import Posture
from ...core.body.rotations import continuous_quaternions, to_quaternions
from ...core.body.skeleton import JointKind
from .armature import BoneModel

PATHS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
ALL_PATHS = ("rotation_quaternion", "rotation_axis_angle", "rotation_euler")


def rotation_path(mode: str) -> str:
    """The property that holds the rotation in `mode`: one of ALL_PATHS."""
    return PATHS.get(mode, "rotation_euler")


def bone_path(bone: str, channel: str) -> str:
    """Data path of a pose bone's property."""
    return f'pose.bones["{bpy.utils.escape_identifier(bone)}"].{channel}'


def rotation_values(rotation: Array, mode: str) -> Array:
    """(F, 4) or (F, 3) values of the property `rotation_path(mode)` of rotations (F, 3, 3), without jumps."""
    if mode == "QUATERNION":
        return continuous_quaternions(to_quaternions(rotation))
    from scipy.spatial.transform import Rotation

    if mode != "AXIS_ANGLE":
        return _continuous_eulers(Rotation.from_matrix(rotation).as_euler(mode.lower()), mode)
    vectors = Rotation.from_matrix(rotation).as_rotvec()
    angles = np.linalg.norm(vectors, axis=-1)
    turned = angles >= 1e-7
    axes = np.concatenate([[[0.0, 1.0, 0.0]], vectors / np.where(turned, angles, 1.0)[:, None]])
    # Where it hardly turns, the axis stays the last one; before the first turn it is Y, as of new bones.
    rows = np.maximum.accumulate(np.where(turned, 1 + np.arange(len(angles)), 0))
    axes = axes[np.concatenate([[0], rows])]
    # The opposite axis and angle are the same rotation; where they lie nearer, they are taken.
    signs = np.cumprod(np.where(np.sum(axes[1:] * axes[:-1], axis=-1) < 0.0, -1.0, 1.0))
    unwrapped = np.unwrap(signs * np.where(turned, angles, 0.0))
    return np.concatenate([unwrapped[:, None], signs[:, None] * axes[1:]], axis=-1)


def _continuous_eulers(angles: Array, order: str) -> Array:
    # Blender's XYZ turns about the fixed x first, then y, then z: scipy's lower case.
    # The second triple is the same rotation; it is the nearer one after passing the pole.
    triples = np.stack([angles, angles * [1.0, -1.0, 1.0] + np.pi])
    steps = triples[None, :, 1:] - triples[:, None, :-1]
    ways = np.abs(steps - 2.0 * np.pi * np.round(steps / (2.0 * np.pi))).sum(axis=-1)  # (from, to, F - 1)
    chosen = [0]
    for nearer in (ways[:, 1] < ways[:, 0]).T.astype(int).tolist():
        chosen.append(nearer[chosen[-1]])
    values = np.empty((len(angles), 3))
    columns = ["XYZ".index(axis) for axis in order]
    values[:, columns] = np.unwrap(triples[chosen, np.arange(len(angles))], axis=0)
    return values


def posture_from_frames(models: tuple[BoneModel, ...], frames: Mapping[str, Array], hips: Array) -> Posture:
    """The posture nearest to world orientations (..., 3, 3) of joints, by bone, and hips (..., 3) [m].

    Every joint is fitted against the frame its parent was fitted to, so that what a hinge cannot follow
    does not turn the limb beyond it. `models` are parents first.
    """
    still = np.broadcast_to(np.eye(3), (*hips.shape[:-1], 3, 3))
    turns = {joint: still for joint in HUMAN.ball_joints}
    angles = {joint: np.zeros(hips.shape[:-1]) for joint in HUMAN.hinge_joints}
    reached: dict[str | None, Array] = {None: still}
    for model in models:
        above = reached[model.parent]
        relative = np.swapaxes(above, -1, -2) @ frames[model.name]
        hinges = [i for i in model.chain if HUMAN.joints[i].kind is JointKind.HINGE]
        if hinges:
            fitted = nearest_hinges([np.asarray(HUMAN.joints[i].axis) for i in hinges], relative)
            angles.update(zip(hinges, fitted, strict=True))
            relative = still
            for joint in hinges:
                relative = relative @ rotations.hinge(np.asarray(HUMAN.joints[joint].axis), angles[joint])
        elif model.chain:
            turns[model.chain[0]] = relative
        else:
            relative = still
        reached[model.name] = above @ relative
    return Posture(
        HUMAN,
        hips,
        np.stack([turns[joint] for joint in HUMAN.ball_joints], axis=-3),
        np.stack([angles[joint] for joint in HUMAN.hinge_joints], axis=-1),
    )


def nearest_hinges(axes: list[Array], rotation: Array) -> list[Array]:
    """Angles (...,) of a chain of hinges whose product is nearest to rotations (..., 3, 3).

    Each angle has a closed form when the others are held; alternating settles within a few sweeps and
    at once where the rotation is within reach. `axes` are unit vectors in the order of the product.
    """
    angles = [np.zeros(rotation.shape[:-2]) for _ in axes]
    if len(axes) == 2:  # start where the chain is exact, so that no other local optimum is found
        first, second = axes
        target, across = rotation @ second, second - (second @ first) * first
        angles[0] = np.asarray(np.arctan2(target @ np.cross(first, across), target @ across))
    for _ in range(50):
        before = list(angles)
        for i, axis in enumerate(axes):
            left, right = np.eye(3), np.eye(3)
            for j, other in enumerate(axes):
                turn = rotations.hinge(other, angles[j])
                if j < i:
                    left = left @ turn
                elif j > i:
                    right = right @ turn
            # The angle that maximizes trace(rest @ hinge(angle).T).
            rest = np.swapaxes(left, -1, -2) @ rotation @ np.swapaxes(right, -1, -2)
            skew = rest[..., [2, 0, 1], [1, 2, 0]] - rest[..., [1, 2, 0], [2, 0, 1]]
            along = np.trace(rest, axis1=-2, axis2=-1) - (rest @ axis) @ axis
            angles[i] = np.asarray(np.arctan2(skew @ axis, along))
        if np.abs(np.subtract(before, angles)).max() < 1e-12:
            break
    return angles
