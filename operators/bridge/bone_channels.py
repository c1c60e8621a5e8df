"""Bone channels from postures over time: rotations, and the root's location, relative to the rest pose."""

from collections.abc import Mapping
from dataclasses import dataclass

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body import rotations
from ...core.body.extremities import RIGID, Extremities
from ...core.body.posture import Posture
from ...core.body.skeleton import JointKind, Skeleton
from .actor_lengths import skeleton_bones
from .bones import BoneModel
from .object_space import ObjectSpace, object_space


@dataclass(frozen=True, eq=False)
class BoneChannels:
    """Channels of one bone over F postures."""

    bone: str
    rotation: Array
    """(F, 3, 3) relative to the bone's rest."""
    location: Array | None
    """(F, 3) [m, before the object's scale]; None for all but the root."""


def bone_channels(
    armature_object: bpy.types.Object, postures: Posture, extremities: Extremities = RIGID
) -> tuple[BoneChannels, ...]:
    """Channels of bones that show a batch of postures in the world.

    Args:
        armature_object: An armature with the skeleton's bones, with any location, even scale and rest pose.
        postures: A batch of F.
        extremities: Hands and feet; those that are not listed get no channels.

    Raises:
        InputError: A bone is missing, or the object is scaled unevenly.
    """
    models = skeleton_bones(armature_object, postures.skeleton)
    bones = armature_object.data.bones
    rest = {model.name: np.array(bones[model.name].matrix_local, dtype=np.float64) for model in models}
    return channels_at_rest(models, rest, object_space(armature_object), postures, extremities)


def channels_at_rest(
    models: tuple[BoneModel, ...],
    rest: Mapping[str, Array],
    space: ObjectSpace,
    postures: Posture,
    extremities: Extremities = RIGID,
) -> tuple[BoneChannels, ...]:
    """Channels as `bone_channels`, of bones that need not be in an armature.

    Args:
        models: The skeleton's bones, parents first.
        rest: (4, 4) rest matrix of each bone, in the object's space.
        space: From the object's space to the world.
        postures: A batch of F.
        extremities: Hands and feet; those that are not listed get no channels.
    """
    frames: dict[str, Array] = {}
    channels = []
    for model in models:
        frames[model.name] = _joint_frame(postures, model, frames)
        if model.name in extremities.turns:
            frames[model.name] = frames[model.name] @ extremities.turns[model.name]
        elif not model.chain:
            continue
        turn = rest[model.name][:3, :3]
        posed = _posed(frames, model, space.rotation)
        location = None
        if model.parent is None:
            head = space.from_world(postures.translation + frames[model.name] @ model.start)
            location = (head - rest[model.name][:3, 3]) @ turn
        else:
            above = next(other for other in models if other.name == model.parent)
            turn = rest[model.parent][:3, :3].T @ turn
            posed = np.swapaxes(_posed(frames, above, space.rotation), -1, -2) @ posed
        channels.append(BoneChannels(model.name, turn.T @ posed, location))
    return tuple(channels)


def _joint_frame(postures: Posture, model: BoneModel, frames: dict[str, Array]) -> Array:
    """(F, 3, 3) world orientation of the bone's joint."""
    skeleton: Skeleton = postures.skeleton
    frame = np.broadcast_to(np.eye(3), (*postures.batch, 3, 3))
    if model.parent is not None:
        frame = frames[model.parent]
    for joint in model.chain:
        if skeleton.joints[joint].kind is JointKind.HINGE:
            angle = postures.angles[..., skeleton.hinge_joints.index(joint)]
            frame = frame @ rotations.hinge(np.asarray(skeleton.joints[joint].axis), angle)
        else:
            frame = frame @ postures.rotations[..., skeleton.ball_joints.index(joint), :, :]
    return frame


def _posed(frames: dict[str, Array], model: BoneModel, object_rotation: Array) -> Array:
    """(F, 3, 3) the bone's axes in the object's space."""
    return np.asarray(object_rotation.T @ frames[model.name] @ model.axes)
