"""F-curves of a motion, in an Action that animates the actor's armature."""

from collections.abc import Callable, Iterable

import bpy

from ...core.arrays import Array
from ...core.body.posture import Posture
from ...core.body.skeleton import Skeleton
from ...core.take.motion import Motion
from .actions import assign_action, channelbag_for, existing_channelbag
from .actor_lengths import skeleton_bones
from .bone_channels import BoneChannels, bone_channels
from .keys import add_generated_keys, copy_as_generated, ensure_fcurve, remove_generated_keys
from .rotation_modes import ALL_PATHS, rotation_path, rotation_values


def posture_columns(
    armature_object: bpy.types.Object, postures: Posture
) -> list[tuple[str, int, str, Array]]:
    """Contents of the F-curves of a batch of F postures.

    Every bone keeps the rotation mode that the animator has chosen.

    Returns:
        Data path, array index, bone and values (F,) of each F-curve.

    Raises:
        InputError: A bone is missing, or the object is scaled unevenly.
    """
    bones = armature_object.pose.bones
    return channel_columns(bone_channels(armature_object, postures), lambda bone: bones[bone].rotation_mode)


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


def bone_path(bone: str, channel: str) -> str:
    """Data path of a pose bone's property."""
    return f'pose.bones["{bpy.utils.escape_identifier(bone)}"].{channel}'


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
    """Write a motion as an Action and let it animate the armature.

    A group for each bone, a GENERATED key for each frame and channel, in the bone's own rotation mode.
    Written again into the same Action, it replaces only such keys; the animator's stay and win their frames.

    Args:
        armature_object: The actor, with any location and even scale; it shows the motion's world positions.
        motion: The motion to write.
        action: The Action to write into; a new one by default.
        keyframe_action: Where the animator keyed bones without degrees of freedom (hands, feet); their curves
            are copied, so that they move as posed.
        frames: (F,) scene frames; the motion's own by default.

    Raises:
        InputError: A bone is missing, or the object is scaled unevenly.
    """
    columns = posture_columns(armature_object, motion.posture)
    frames = motion.scene_frames if frames is None else frames
    if action is None:
        action = bpy.data.actions.new(f"{armature_object.name} Motion")
    channelbag = channelbag_for(action, armature_object)
    remove_generated_keys(channelbag, moved_paths(armature_object, motion.body.skeleton))
    for path, index, bone, column in columns:
        add_generated_keys(channelbag, path, index, bone, frames, column)
    if keyframe_action is not None:
        _copy_leaves(armature_object, motion.body.skeleton, keyframe_action, channelbag)
    assign_action(armature_object, action)
    return action


def _copy_leaves(
    armature_object: bpy.types.Object,
    skeleton: Skeleton,
    source: bpy.types.Action,
    channelbag: bpy.types.ActionChannelbag,
) -> None:
    """Copy the curves of bones without degrees of freedom; of what is there, only earlier copies go."""
    leaves = {
        bone_path(model.name, channel): model.name
        for model in skeleton_bones(armature_object, skeleton)
        if not model.chain
        for channel in (*ALL_PATHS, "location")
    }
    remove_generated_keys(channelbag, leaves)
    given = existing_channelbag(source, armature_object)
    for curve in given.fcurves if given is not None else ():
        bone = leaves.get(curve.data_path)
        if bone is None:
            continue
        copy_as_generated(curve, ensure_fcurve(channelbag, curve.data_path, curve.array_index, bone))
