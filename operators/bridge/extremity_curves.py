"""Curves of hands and feet: which the animator has posed, and what a motion has turned by itself.

Storing a keyframe keys them too, as they stand: at rest, they count as not posed.
"""

from collections.abc import Collection

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.kinematics import extremity_names
from ...core.body.skeleton import Skeleton
from .actions import existing_channelbag
from .keys import MOTION, copy_as_generated, ensure_fcurve, unchanged_frames
from .rotation_modes import ALL_PATHS, bone_path, rotation_path

AT_REST = {"rotation_quaternion": (None, 0.0, 0.0, 0.0), "rotation_axis_angle": (0.0, None, None, None)}
"""Values of channels that do not turn a bone, None for any; Euler angles are all zero."""
SAME_VALUE = 1e-4  # channels that differ by less [rad, m] are the same


def extremity_paths(skeleton: Skeleton) -> dict[str, str]:
    """Names of hands and feet by the data paths of their channels."""
    return {
        bone_path(name, channel): name
        for name in extremity_names(skeleton)
        for channel in (*ALL_PATHS, "location")
    }


def posed_extremities(
    armature_object: bpy.types.Object, skeleton: Skeleton, keyframe_action: bpy.types.Action | None
) -> frozenset[str]:
    """Names of the hands and feet that the animator has keyed away from rest in the Action of keyframes."""
    given = None if keyframe_action is None else existing_channelbag(keyframe_action, armature_object)
    if given is None:
        return frozenset()
    return frozenset(
        name
        for name in extremity_names(skeleton)
        if any(_leaves_rest(curve) for curve in _shown_curves(armature_object, given, name))
    )


def turned_extremities(
    armature_object: bpy.types.Object,
    skeleton: Skeleton,
    action: bpy.types.Action,
    keyframe_action: bpy.types.Action | None,
) -> dict[str, Array]:
    """Frames of the unchanged keys by which a motion has turned hands and feet by itself, by name.

    What is posed in the keyframe Action, the motion only copies.
    """
    given = existing_channelbag(action, armature_object)
    if given is None:
        return {}
    posed = posed_extremities(armature_object, skeleton, keyframe_action)
    found = {
        name: _generated_in_all(_shown_curves(armature_object, given, name))
        for name in extremity_names(skeleton)
        if name not in posed
    }
    return {name: frames for name, frames in found.items() if len(frames)}


def copy_posed_extremities(
    armature_object: bpy.types.Object,
    skeleton: Skeleton,
    source: bpy.types.Action,
    posed: Collection[str],
    channelbag: bpy.types.ActionChannelbag,
) -> None:
    """Copy the curves of some hands and feet as GENERATED keys; where the animator has a key, that stays."""
    paths = extremity_paths(skeleton)
    given = existing_channelbag(source, armature_object)
    for curve in given.fcurves if given is not None else ():
        bone = paths.get(curve.data_path, "")
        if bone in posed:
            copy_as_generated(curve, ensure_fcurve(channelbag, curve.data_path, curve.array_index, bone))


def straighten_extremities(
    armature_object: bpy.types.Object,
    skeleton: Skeleton,
    action: bpy.types.Action,
    keyframe_action: bpy.types.Action | None,
    frame: float,
) -> None:
    """Put hands and feet back to rest that stand, at a scene frame, as the Action of a motion turned them.

    Nobody has posed them: Blender leaves a channel without keys as it was, so that they would stay turned
    under the next Action, and would be keyed with the next pose. What is posed in the keyframe Action stays.
    """
    given = existing_channelbag(action, armature_object)
    posed = posed_extremities(armature_object, skeleton, keyframe_action)
    if given is None:
        return
    for name in extremity_names(skeleton):
        bone = armature_object.pose.bones.get(name)
        if bone is None or name in posed:
            continue
        path = rotation_path(bone.rotation_mode)
        curves = [given.fcurves.find(bone_path(name, path), index=i) for i in range(len(getattr(bone, path)))]
        if None in curves:
            continue
        shown = np.array([curve.evaluate(frame) for curve in curves])
        if np.abs(shown - np.array(getattr(bone, path))).max() < SAME_VALUE:
            bone.rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
            bone.rotation_euler = (0.0, 0.0, 0.0)
            bone.rotation_axis_angle = (0.0, 0.0, 1.0, 0.0)


def _shown_curves(
    armature_object: bpy.types.Object, channelbag: bpy.types.ActionChannelbag, name: str
) -> list[bpy.types.FCurve]:
    """The curves that move a hand or foot: those of its rotation mode, and of its location."""
    bone = armature_object.pose.bones.get(name)
    if bone is None:
        return []
    paths = {bone_path(name, rotation_path(bone.rotation_mode)), bone_path(name, "location")}
    return [curve for curve in channelbag.fcurves if curve.data_path in paths and not curve.mute]


def _leaves_rest(curve: bpy.types.FCurve) -> bool:
    channel = curve.data_path.rpartition(".")[2]
    rest = AT_REST.get(channel, (0.0, 0.0, 0.0))[curve.array_index]
    if rest is None or not len(curve.keyframe_points):
        return False
    coordinates = np.empty((len(curve.keyframe_points), 2), np.float32)
    curve.keyframe_points.foreach_get("co", coordinates.ravel())
    return bool(np.abs(coordinates[:, 1] - rest).max() > SAME_VALUE)


def _generated_in_all(curves: list[bpy.types.FCurve]) -> Array:
    """Frames (N,) that have an unchanged GENERATED key in every curve."""
    rotations = [
        unchanged_frames(curve, MOTION) for curve in curves if not curve.data_path.endswith(".location")
    ]
    found = rotations[0] if rotations else np.zeros(0)
    for frames in rotations[1:]:
        found = found[np.isin(np.round(found, 3), np.round(frames, 3))]
    return found
