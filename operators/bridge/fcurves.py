"""F-curves of a motion, in an Action that animates the actor's armature."""

from collections.abc import Callable, Iterable

import bpy

from ...core.arrays import Array
from ...core.body.extremities import RIGID, Extremities
from ...core.body.posture import Posture
from ...core.body.skeleton import Skeleton
from ...core.finish.natural_extremities import natural_extremities
from ...core.take.motion import Motion
from .actions import assign_action, channelbag_for
from .actor_lengths import skeleton_bones
from .bone_channels import BoneChannels, bone_channels
from .extremity_curves import copy_posed_extremities, extremity_paths, posed_extremities
from .keys import add_generated_keys, remove_generated_keys
from .rotation_modes import ALL_PATHS, bone_path, rotation_path, rotation_values


def posture_columns(
    armature_object: bpy.types.Object, postures: Posture, extremities: Extremities = RIGID
) -> list[tuple[str, int, str, Array]]:
    """Contents of the F-curves of a batch of F postures, and of the hands and feet that are given.

    Every bone keeps the rotation mode that the animator has chosen.

    Returns:
        Data path, array index, bone and values (F,) of each F-curve.

    Raises:
        InputError: A bone is missing, or the object is scaled unevenly.
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
    """Write a motion as an Action and let it animate the armature.

    A group for each bone, a GENERATED key for each frame and channel, in the bone's own rotation mode.
    Written again into the same Action, it replaces only such keys; the animator's stay and win their frames.

    Args:
        armature_object: The actor, with any location and even scale; it shows the motion's world positions.
        motion: The motion to write.
        action: The Action to write into; a new one by default.
        keyframe_action: Where the animator may have posed hands and feet; those that are move as their curves
            there say, the others naturally.
        frames: (F,) scene frames; the motion's own by default.

    Raises:
        InputError: A bone is missing, or the object is scaled unevenly.
    """
    skeleton = motion.body.skeleton
    posed = posed_extremities(armature_object, skeleton, keyframe_action)
    natural = natural_extremities(motion.body, motion.posture, motion.time_s).without(posed)
    columns = posture_columns(armature_object, motion.posture, natural)
    frames = motion.scene_frames if frames is None else frames
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
