"""Curves of hands, fingers and feet: which the animator has posed, and what a motion has turned by itself.

Storing a keyframe keys them too, as they stand: at rest, they count as not posed.
"""

from collections.abc import Collection

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.fingers import FINGER_BONES
from ...core.body.human import HUMAN
from ...core.body.kinematics import extremity_names
from .actions import curves_of
from .keys import MOTION, copy_as_generated, ensure_fcurve, unchanged_frames
from .rotation_modes import ALL_PATHS, bone_path, rotation_path

AT_REST = {"rotation_quaternion": (None, 0.0, 0.0, 0.0), "rotation_axis_angle": (0.0, None, None, None)}
"""Values of channels that do not turn a bone, None for any; Euler angles are all zero."""
EXTREMITIES = (*extremity_names(HUMAN), *FINGER_BONES)
SAME_VALUE = 1e-4  # channels that differ by less [rad, m] are the same
EXTREMITY_PATHS = {
    bone_path(name, channel): name for name in EXTREMITIES for channel in (*ALL_PATHS, "location")
}
"""Their names by the data paths of their channels."""


def posed_extremities(
    armature_object: bpy.types.Object, keyframe_action: bpy.types.Action | None
) -> frozenset[str]:
    """Names of the hands and feet that the animator has keyed away from rest in the Action of keyframes."""
    if keyframe_action is None:
        return frozenset()
    shown = _shown_curves(armature_object, keyframe_action)
    return frozenset(name for name, curves in shown.items() if any(map(_leaves_rest, curves)))


def turned_extremities(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    keyframe_action: bpy.types.Action | None,
) -> dict[str, Array]:
    """Frames of the unchanged keys by which a motion has turned hands and feet by itself, by name.

    What is posed in the keyframe Action, the motion only copies. A frame has such a key in every curve.
    """
    posed = posed_extremities(armature_object, keyframe_action)
    found = {}
    for name, curves in _shown_curves(armature_object, action).items():
        turns = [curve for curve in curves if not curve.data_path.endswith(".location")]
        if name not in posed and turns:
            frames, *others = (unchanged_frames(curve, MOTION) for curve in turns)
            for other in others:
                frames = frames[np.isin(np.round(frames, 3), np.round(other, 3))]
            found[name] = frames
    return {name: frames for name, frames in found.items() if len(frames)}


def copy_posed_extremities(
    armature_object: bpy.types.Object,
    source: bpy.types.Action,
    posed: Collection[str],
    channelbag: bpy.types.ActionChannelbag,
) -> None:
    """Copy the curves of some hands and feet as GENERATED keys; where the animator has a key, that stays."""
    for (path, index), curve in curves_of(source, armature_object).items():
        if EXTREMITY_PATHS.get(path) in posed:
            copy_as_generated(curve, ensure_fcurve(channelbag, path, index, EXTREMITY_PATHS[path]))


def straighten_extremities(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    keyframe_action: bpy.types.Action | None,
    frame: float,
) -> None:
    """Put hands and feet back to rest that stand, at a scene frame, as the Action of a motion turned them.

    Nobody has posed them: Blender leaves a channel without keys as it was, so that they would stay turned
    under the next Action, and would be keyed with the next pose. What is posed in the keyframe Action stays.
    """
    given = curves_of(action, armature_object)
    posed = posed_extremities(armature_object, keyframe_action)
    for name in set(EXTREMITIES) - posed:
        bone = armature_object.pose.bones.get(name)
        if bone is None:
            continue
        values = np.array(getattr(bone, rotation_path(bone.rotation_mode)))
        path = bone_path(name, rotation_path(bone.rotation_mode))
        curves = [given.get((path, index)) for index in range(len(values))]
        shown = np.array([np.nan if curve is None else curve.evaluate(frame) for curve in curves])
        if np.abs(shown - values).max() < SAME_VALUE:  # not so where a curve is missing
            bone.rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
            bone.rotation_euler = (0.0, 0.0, 0.0)
            bone.rotation_axis_angle = (0.0, 0.0, 1.0, 0.0)


def _shown_curves(
    armature_object: bpy.types.Object, action: bpy.types.Action
) -> dict[str, list[bpy.types.FCurve]]:
    """The curves that move each of them: those of its rotation mode, and of its location."""
    curves = curves_of(action, armature_object)
    found = {}
    for name in EXTREMITIES:
        bone = armature_object.pose.bones.get(name)
        if bone is not None:
            paths = {bone_path(name, rotation_path(bone.rotation_mode)), bone_path(name, "location")}
            found[name] = [curve for (path, _), curve in curves.items() if path in paths and not curve.mute]
    return found


def _leaves_rest(curve: bpy.types.FCurve) -> bool:
    channel = curve.data_path.rpartition(".")[2]
    rest = AT_REST.get(channel, (0.0, 0.0, 0.0))[curve.array_index]
    return rest is not None and any(abs(key.co[1] - rest) > SAME_VALUE for key in curve.keyframe_points)
