"""Postures over time as F-curves of bones, relative to the rest pose, and motions as Actions."""

import bpy
import numpy as np
from bpy.types import Action, Object

from ...core.arrays import Array
from ...core.body.fingers import finger_turns
from ...core.body.kinematics import RIGID, Extremities
from ...core.body.posture import Posture
from ...core.feet.natural_extremities import natural_extremities
from ...core.take.motion import Motion
from .actions import assign_action, channelbag_for
from .actor_lengths import add_fingers, read_bones, skeleton_bones
from .armature import ActorBones
from .extremity_curves import EXTREMITY_PATHS, copy_posed_extremities, posed_extremities
from .keys import MOTION, Column, remove_generated_keys, write_keys
from .rotation_modes import ALL_PATHS, bone_path, rotation_path, rotation_values


def posture_columns(bones: ActorBones, postures: Posture, extremities: Extremities = RIGID) -> list[Column]:
    """F-curves by which bones, and listed hands and feet, show F postures in the world, grouped by bone."""
    frames: dict[str, Array] = {}
    axes: dict[str, Array] = {}  # the bones' in the object's space
    columns: list[Column] = []
    turns, still = postures.joint_turns(), np.broadcast_to(np.eye(3), (*postures.batch, 3, 3))
    for model in bones.models:
        frame = still if model.parent is None else frames[model.parent]
        for joint in model.chain:
            frame = frame @ turns[joint]
        frames[model.name] = frame
        if model.name in extremities.turns:
            frames[model.name] = frames[model.name] @ extremities.turns[model.name]
        axes[model.name] = posed = np.asarray(bones.space.rotation.T @ frames[model.name] @ model.axes)
        if not model.chain and model.name not in extremities.turns:
            continue
        rest, mode = bones.rest[model.name], bones.modes[model.name]
        turn, channels = rest[:3, :3], {}
        if model.parent is None:
            head = bones.space.from_world(postures.translation + frames[model.name] @ model.start)
            channels["location"] = (head - rest[:3, 3]) @ turn
        else:
            turn = bones.rest[model.parent][:3, :3].T @ turn
            posed = np.swapaxes(axes[model.parent], -1, -2) @ posed
        channels = {rotation_path(mode): rotation_values(turn.T @ posed, mode), **channels}
        for channel, values in channels.items():
            path = bone_path(model.name, channel)
            columns += [(path, index, model.name, column) for index, column in enumerate(values.T)]
    return columns


def moved_paths(armature_object: Object) -> tuple[str, ...]:
    """Data paths of all channels of a posture: rotations in every mode, and the root's location."""
    return tuple(
        bone_path(model.name, channel)
        for model in skeleton_bones(armature_object)
        if model.chain
        for channel in (*ALL_PATHS, *(("location",) if model.parent is None else ()))
    )


def write_motion(
    armature_object: Object,
    motion: Motion,
    action: Action | None = None,
    keyframe_action: Action | None = None,
    frames: Array | None = None,
) -> Action:
    """Write a motion as an Action, a new one by default, and let it animate the armature.

    It has a GENERATED key for each frame and channel, in the bone's own rotation mode. Written again, it
    replaces only such keys; the animator's stay and win their frames. Hands, fingers and feet that are posed
    in `keyframe_action` move as their curves there say, the others as they are seen or naturally. `frames`
    (F,) are scene frames.
    """
    posed = posed_extremities(armature_object, keyframe_action)
    frames = (motion.scene_frames if frames is None else frames)[motion.there]
    shown = motion.without_absence()  # no keys where the performer is not there
    turns = natural_extremities(shown.body, shown.posture, shown.time_s, hands=shown.hands).turns
    if shown.hands is not None:
        add_fingers(armature_object, shown.body)
        turns = {**turns, **finger_turns(shown.hands)}
    extremities = Extremities(turns).without(posed)
    columns = posture_columns(read_bones(armature_object), shown.posture, extremities)
    action = action or bpy.data.actions.new(f"{armature_object.name} Motion")
    channelbag = channelbag_for(action, armature_object)
    remove_generated_keys(channelbag, [*moved_paths(armature_object), *EXTREMITY_PATHS])
    write_keys(channelbag, columns, frames, MOTION)
    if keyframe_action is not None:
        copy_posed_extremities(armature_object, keyframe_action, posed, channelbag)
    assign_action(armature_object, action)
    return action
