"""Postures over time as bone channels, relative to the rest pose, and as F-curves of an Action."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body import rotations
from ...core.body.kinematics import RIGID, Extremities
from ...core.body.posture import Posture
from ...core.body.skeleton import JointKind, Skeleton
from ...core.finish.natural_extremities import natural_extremities
from ...core.take.motion import Motion
from .actions import assign_action, channelbag_for
from .actor_lengths import skeleton_bones
from .armature import BoneModel
from .extremity_curves import copy_posed_extremities, extremity_paths, posed_extremities
from .keys import add_generated_keys, remove_generated_keys
from .object_space import ObjectSpace, object_space
from .rotation_modes import ALL_PATHS, bone_path, rotation_path, rotation_values


@dataclass(frozen=True, eq=False)
class BoneChannels:
    """Channels of one bone over F postures."""

    bone: str
    rotation: Array  # (F, 3, 3) relative to the bone's rest
    location: Array | None  # (F, 3) [m, before the object's scale]; None for all but the root


def bone_channels(
    armature_object: bpy.types.Object, postures: Posture, extremities: Extremities = RIGID
) -> tuple[BoneChannels, ...]:
    """Channels of bones that show F postures in the world; hands and feet that are not listed get none.

    The armature may have any location, even scale and rest pose.
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

    `models` are parents first; `rest` has each bone's rest matrix (4, 4) in the object's space.
    """
    frames: dict[str, Array] = {}
    axes: dict[str, Array] = {}  # the bones' in the object's space
    channels = []
    for model in models:
        frames[model.name] = _joint_frame(postures, model, frames)
        if model.name in extremities.turns:
            frames[model.name] = frames[model.name] @ extremities.turns[model.name]
        elif not model.chain:
            continue
        axes[model.name] = posed = np.asarray(space.rotation.T @ frames[model.name] @ model.axes)
        turn, location = rest[model.name][:3, :3], None
        if model.parent is None:
            head = space.from_world(postures.translation + frames[model.name] @ model.start)
            location = (head - rest[model.name][:3, 3]) @ turn
        else:
            turn = rest[model.parent][:3, :3].T @ turn
            posed = np.swapaxes(axes[model.parent], -1, -2) @ posed
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


def posture_columns(
    armature_object: bpy.types.Object, postures: Posture, extremities: Extremities = RIGID
) -> list[tuple[str, int, str, Array]]:
    """Data path, array index, bone and values (F,) of the F-curves of F postures and their extremities.

    Every bone keeps the rotation mode that the animator has chosen.
    """
    bones = armature_object.pose.bones
    channels = bone_channels(armature_object, postures, extremities)
    return channel_columns(channels, lambda bone: bones[bone].rotation_mode)


def channel_columns(
    channels: Iterable[BoneChannels], mode_of: Callable[[str], str]
) -> list[tuple[str, int, str, Array]]:
    """Contents of the F-curves of bone channels; `mode_of` gives a bone's rotation mode by its name."""
    rows = []
    for channel in channels:
        mode = mode_of(channel.bone)
        values = {rotation_path(mode): rotation_values(channel.rotation, mode)}
        if channel.location is not None:
            values["location"] = channel.location
        for name, columns in values.items():
            path = bone_path(channel.bone, name)
            rows += [(path, index, channel.bone, column) for index, column in enumerate(columns.T)]
    return rows


def moved_paths(armature_object: bpy.types.Object, skeleton: Skeleton) -> tuple[str, ...]:
    """Data paths of all channels of a posture: rotations in every mode, and the root's location."""
    return tuple(
        bone_path(model.name, channel)
        for model in skeleton_bones(armature_object, skeleton)
        if model.chain
        for channel in (*ALL_PATHS, *(("location",) if model.is_root else ()))
    )


def write_motion(
    armature_object: bpy.types.Object,
    motion: Motion,
    action: bpy.types.Action | None = None,
    keyframe_action: bpy.types.Action | None = None,
    frames: Array | None = None,
) -> bpy.types.Action:
    """Write a motion as an Action, a new one by default, and let it animate the armature.

    A group for each bone, a GENERATED key for each frame and channel, in the bone's own rotation mode.
    Written again into the same Action, it replaces only such keys; the animator's stay and win their frames.
    Hands and feet that are posed in `keyframe_action` move as their curves there say, the others naturally.
    `frames` (F,) are scene frames; the motion's own by default.
    """
    skeleton = motion.body.skeleton
    posed = posed_extremities(armature_object, skeleton, keyframe_action)
    frames = (motion.scene_frames if frames is None else frames)[motion.there]
    shown = motion.without_absence()  # no keys where the performer is not there
    natural = natural_extremities(shown.body, shown.posture, shown.time_s).without(posed)
    columns = posture_columns(armature_object, shown.posture, natural)
    if action is None:
        action = bpy.data.actions.new(f"{armature_object.name} Motion")
    channelbag = channelbag_for(action, armature_object)
    remove_generated_keys(channelbag, moved_paths(armature_object, skeleton))
    remove_generated_keys(channelbag, extremity_paths(skeleton))
    for path, index, bone, column in columns:
        add_generated_keys(channelbag, path, index, bone, frames, column)
    if keyframe_action is not None:
        copy_posed_extremities(armature_object, skeleton, keyframe_action, posed, channelbag)
    assign_action(armature_object, action)
    return action
