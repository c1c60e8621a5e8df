"""Postures fitted to joint frames: exact within the skeleton's freedoms, else the nearest.

All functions take a single pose or a batch of them: leading axes `...` are those of `frames`.
"""

from collections.abc import Mapping

import numpy as np

from ...core.arrays import Array
from ...core.body import rotations
from ...core.body.posture import Posture
from ...core.body.skeleton import JointKind, Skeleton
from .bones import BoneModel

SWEEPS = 50
CONVERGED_RAD = 1e-12


def posture_from_frames(
    skeleton: Skeleton, models: tuple[BoneModel, ...], frames: Mapping[str, Array], hips: Array
) -> Posture:
    """The posture nearest to given orientations of the bones' joints.

    Every joint is fitted against the frame its parent was fitted to, so that what a hinge cannot follow
    does not turn the limb beyond it.

    Args:
        skeleton: The skeleton the bones belong to.
        models: Its bones, parents first.
        frames: World orientation (..., 3, 3) of each bone's joint, by name of bone.
        hips: (..., 3) world position of the root [m].
    """
    still = np.broadcast_to(np.eye(3), (*hips.shape[:-1], 3, 3))
    turns = {joint: still for joint in skeleton.ball_joints}
    angles = {joint: np.zeros(hips.shape[:-1]) for joint in skeleton.hinge_joints}
    reached: dict[str | None, Array] = {None: still}
    for model in models:
        above = reached[model.parent]
        relative = np.swapaxes(above, -1, -2) @ frames[model.name]
        hinges = [i for i in model.chain if skeleton.joints[i].kind is JointKind.HINGE]
        if hinges:
            fitted = nearest_hinges([np.asarray(skeleton.joints[i].axis) for i in hinges], relative)
            angles.update(zip(hinges, fitted, strict=True))
            relative = still
            for joint, angle in zip(hinges, fitted, strict=True):
                relative = relative @ rotations.hinge(np.asarray(skeleton.joints[joint].axis), angle)
        elif model.chain:
            turns[model.chain[0]] = relative
        else:
            relative = still
        reached[model.name] = above @ relative
    return Posture(
        skeleton,
        hips,
        np.stack([turns[joint] for joint in skeleton.ball_joints], axis=-3),
        np.stack([angles[joint] for joint in skeleton.hinge_joints], axis=-1),
    )


def nearest_hinges(axes: list[Array], rotation: Array) -> list[Array]:
    """Angles of a chain of hinges whose product is nearest to a rotation (least angle between both).

    Each angle has a closed form when the others are held; alternating settles within a few sweeps and
    at once where the rotation is within reach.

    Args:
        axes: Unit axis (3,) of each hinge, in the order of the product.
        rotation: (..., 3, 3).

    Returns:
        Angle (...,) of each hinge [rad].
    """
    angles = [np.zeros(rotation.shape[:-2]) for _ in axes]
    if len(axes) == 2:  # start where the chain is exact, so that no other local optimum is found
        angles[0] = _first_angle(axes[0], axes[1], rotation)
    for _ in range(SWEEPS):
        before = list(angles)
        for i, axis in enumerate(axes):
            left, right = np.eye(3), np.eye(3)
            for j, other in enumerate(axes):
                turn = rotations.hinge(other, angles[j])
                if j < i:
                    left = left @ turn
                elif j > i:
                    right = right @ turn
            angles[i] = _nearest_angle(
                axis, np.swapaxes(left, -1, -2) @ rotation @ np.swapaxes(right, -1, -2)
            )
        if np.abs(np.subtract(before, angles)).max() < CONVERGED_RAD:
            break
    return angles


def _nearest_angle(axis: Array, rotation: Array) -> Array:
    """(...,) the angle that maximizes trace(rotation @ hinge(angle).T)."""
    skew = np.stack(
        [
            rotation[..., 2, 1] - rotation[..., 1, 2],
            rotation[..., 0, 2] - rotation[..., 2, 0],
            rotation[..., 1, 0] - rotation[..., 0, 1],
        ],
        axis=-1,
    )
    along = (rotation @ axis) @ axis
    return np.asarray(np.arctan2(skew @ axis, np.trace(rotation, axis1=-2, axis2=-1) - along))


def _first_angle(first: Array, second: Array, rotation: Array) -> Array:
    """(...,) the first of two hinges' angle that brings the second's axis nearest to where it is turned."""
    target = rotation @ second
    across = second - (second @ first) * first
    return np.asarray(np.arctan2(target @ np.cross(first, across), target @ across))
