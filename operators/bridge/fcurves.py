"""Curves of Actions: those of hands and feet, and what animates a bone."""

import bpy
import numpy as np
from bpy.types import Action, FCurve, Object

from ...core.arrays import Array
from ...core.body.fingers import FINGER_BONES, finger_turns
from ...core.body.human import HUMAN
from ...core.body.kinematics import RIGID, Extremities, extremity_names
from ...core.body.posture import Posture
from ...core.body.skeleton import SIDES
from ...core.feet.natural_extremities import natural_extremities
from ...core.take.motion import Motion
from . import keys
from .actions import assign_action, channelbag_for, curves_of
from .armature import ActorBones, add_fingers, read_bones, skeleton_bones
from .keys import Column, ensure_fcurve, write_keys
from .rotation_modes import ALL_PATHS, bone_path, rotation_path, rotation_values

AT_REST = {"rotation_quaternion": (None, 0.0, 0.0, 0.0), "rotation_axis_angle": (0.0, None, None, None)}
"""Values of channels that do not turn a bone, None for any; Euler angles are all zero."""
EXTREMITIES = (*extremity_names(HUMAN), *FINGER_BONES)
SAME_VALUE = 1e-4  # channels that differ by less [rad, m] are the same
FEET = tuple(f"foot.{side}" for side in SIDES)
EXTREMITY_PATHS = {bone_path(name, one): name for name in EXTREMITIES for one in (*ALL_PATHS, "location")}
"""Their names by the data paths of their channels."""


def posed_extremities(armature_object: Object, keyframe_action: Action | None) -> frozenset[str]:
    """Names of the hands and feet that the animator has keyed away from rest in the Action of keyframes."""
    if keyframe_action is None:
        return frozenset()
    shown = _shown_curves(armature_object, keyframe_action)
    return frozenset(name for name, curves in shown.items() if any(map(_leaves_rest, curves)))


def turned_extremities(
    armature_object: Object, action: Action, keyframe_action: Action | None
) -> dict[str, Array]:
    """Frames of the unchanged keys, in every curve, by which a motion has turned hands and feet by itself.

    What is posed in the keyframe Action, the motion only copies, but for hands that are seen.
    """
    posed = posed_extremities(armature_object, keyframe_action)
    own = {} if keyframe_action is None else _shown_curves(armature_object, keyframe_action)
    found = {}
    for name, curves in _shown_curves(armature_object, action).items():
        turns = [curve for curve in curves if not curve.data_path.endswith(".location")]
        if turns:
            frames, *further = (keys.unchanged_frames(curve, keys.MOTION) for curve in turns)
            for other in further:
                frames = frames[np.isin(np.round(frames, 3), np.round(other, 3))]
            copied = [key.co[0] for curve in own.get(name, ()) for key in curve.keyframe_points]
            if name not in posed or not np.isin(np.round(frames, 3), np.round(copied, 3)).all():
                found[name] = frames
    return {name: frames for name, frames in found.items() if len(frames)}


def straighten_extremities(
    armature_object: Object, action: Action, keyframe_action: Action | None, frame: float
) -> None:
    """Put hands and feet back to rest that stand, at a scene frame, as the Action of a motion turned them.

    Nobody has posed them: Blender leaves a channel without keys as it was, so that they would stay turned
    under the next Action, and would be keyed with the next pose. What is posed in the keyframe Action stays.
    """
    moved = curves_of(action, armature_object)
    posed = posed_extremities(armature_object, keyframe_action)
    for name in set(EXTREMITIES) - posed:
        bone = armature_object.pose.bones.get(name)
        if bone is None:
            continue
        values = np.array(getattr(bone, rotation_path(bone.rotation_mode)))
        path = bone_path(name, rotation_path(bone.rotation_mode))
        curves = [moved.get((path, index)) for index in range(len(values))]
        shown = np.array([np.nan if curve is None else curve.evaluate(frame) for curve in curves])
        if np.abs(shown - values).max() < SAME_VALUE:  # not so where a curve is missing
            bone.rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
            bone.rotation_euler = (0.0, 0.0, 0.0)
            bone.rotation_axis_angle = (0.0, 0.0, 1.0, 0.0)


def _shown_curves(armature_object: Object, action: Action) -> dict[str, list[FCurve]]:
    curves = curves_of(action, armature_object)
    found = {}
    for name in EXTREMITIES:
        bone = armature_object.pose.bones.get(name)
        if bone is not None:
            paths = {bone_path(name, rotation_path(bone.rotation_mode)), bone_path(name, "location")}
            found[name] = [curve for (path, _), curve in curves.items() if path in paths and not curve.mute]
    return found


def _leaves_rest(curve: FCurve) -> bool:
    channel = curve.data_path.rpartition(".")[2]
    rest = AT_REST.get(channel, (0.0, 0.0, 0.0))[curve.array_index]
    return rest is not None and any(abs(key.co[1] - rest) > SAME_VALUE for key in curve.keyframe_points)


# --- Postures over time as F-curves of bones, relative to the rest pose, and motions as Actions


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
    in `keyframe_action` move as their curves there say, the others as they are seen or naturally; those that
    are seen and posed are put right. `frames` (F,) are scene frames.
    """
    posed = posed_extremities(armature_object, keyframe_action)
    frames = (motion.scene_frames if frames is None else frames)[motion.there]
    shown = motion.without_absence()  # no keys where the performer is not there
    turns = {**natural_extremities(shown.body, shown.posture, shown.time_s, hands=shown.hands).turns}
    if shown.hands is not None:
        add_fingers(armature_object, shown.body)
        turns |= finger_turns(shown.hands)
    if shown.hands is not None and keyframe_action is not None:
        from .posed_hands import put_right

        models = {model.name: model for model in read_bones(armature_object).models}
        curves = _shown_curves(armature_object, keyframe_action)
        for name in [name for name in posed if name not in FEET]:
            bone = armature_object.pose.bones[name]
            turns[name] = put_right(turns[name], shown.time_s, frames, bone, models[name], curves[name])
        posed = posed.intersection(FEET)
    extremities = Extremities(turns).without(posed)
    columns = posture_columns(read_bones(armature_object), shown.posture, extremities)
    action = action or bpy.data.actions.new(f"{armature_object.name} Motion")
    channelbag = channelbag_for(action, armature_object)
    keys.remove_generated_keys(channelbag, [*moved_paths(armature_object), *EXTREMITY_PATHS])
    write_keys(channelbag, columns, frames, keys.MOTION)
    source = {} if keyframe_action is None else curves_of(keyframe_action, armature_object)
    for (path, index), curve in source.items():
        if EXTREMITY_PATHS.get(path) in posed:  # where the animator has a key, that stays
            keys.copy_as_generated(curve, ensure_fcurve(channelbag, path, index, EXTREMITY_PATHS[path]))
    assign_action(armature_object, action)
    return action
