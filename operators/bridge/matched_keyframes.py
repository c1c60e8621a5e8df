"""Found keyframes, on the keyframe Action beside the animator's own.

A keyframe counts as found only while all its keys are as they were written. As soon as the animator changes
one, or moves it to another frame, the posture there is the animator's: corrections need no confirmation.
"""

from collections.abc import Collection, Sequence

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.posture import Posture
from ...core.body.skeleton import Skeleton
from .actions import channelbag_for, existing_channelbag
from .actor_lengths import skeleton_bones
from .fcurves import moved_paths, posture_columns
from .keys import give_to_animator, matched_frames_of, remove_keys, set_matched_keys
from .rotation_modes import bone_path, rotation_path

DIGITS = 3
"""Decimals to which frames are told apart, as in `keyed_frames`."""


def untouched_frames(
    armature_object: bpy.types.Object, action: bpy.types.Action, skeleton: Skeleton
) -> tuple[float, ...]:
    """Scene frames whose found posture is unchanged, in order.

    Raises:
        InputError: A bone is missing.
    """
    channelbag = existing_channelbag(action, armature_object)
    if channelbag is None:
        return ()
    found: set[float] | None = None
    for path, index in _curves(armature_object, skeleton):
        fcurve = channelbag.fcurves.find(path, index=index)
        if fcurve is None:
            return ()
        frames = set(np.round(matched_frames_of(fcurve), DIGITS).tolist())
        found = frames if found is None else found & frames
        if not found:
            return ()
    return tuple(sorted(found or ()))


def write_matched(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    frames: Array,
    postures: Sequence[Posture],
) -> None:
    """Key postures as found keyframes; what is keyed on the same frames is replaced, all else stays.

    Args:
        armature_object: The actor.
        action: The Action to key.
        frames: (K,) scene frames, rising.
        postures: K single postures, at least one.

    Raises:
        InputError: A bone is missing, or the object is scaled unevenly.
    """
    channelbag = channelbag_for(action, armature_object)
    columns = posture_columns(armature_object, Posture.stack(list(postures)))
    turned = _turned_to_neighbors(channelbag, columns, frames)
    remove_keys(channelbag, moved_paths(armature_object, postures[0].skeleton), frames)
    for path, index, bone, column in columns:
        set_matched_keys(channelbag, path, index, bone, frames, column * turned.get(path, 1.0))


def remove_keyframes(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    skeleton: Skeleton,
    frames: Collection[float],
) -> None:
    """Remove keyframes; keys of hands and feet stay.

    Raises:
        InputError: A bone is missing.
    """
    channelbag = existing_channelbag(action, armature_object)
    if channelbag is not None:
        remove_keys(channelbag, moved_paths(armature_object, skeleton), np.array(sorted(frames)))


def take_over(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    skeleton: Skeleton,
    frames: Collection[float],
) -> None:
    """Turn found keyframes into the animator's own, as if posed by hand.

    Raises:
        InputError: A bone is missing.
    """
    channelbag = existing_channelbag(action, armature_object)
    if channelbag is not None:
        give_to_animator(channelbag, moved_paths(armature_object, skeleton), np.array(sorted(frames)))


def _curves(armature_object: bpy.types.Object, skeleton: Skeleton) -> list[tuple[str, int]]:
    """Data path and array index of all channels of a posture, in the bones' present rotation modes."""
    curves = []
    for model in skeleton_bones(armature_object, skeleton):
        if not model.chain:
            continue
        bone = armature_object.pose.bones[model.name]
        channels = [rotation_path(bone.rotation_mode), *(["location"] if model.is_root else [])]
        for channel in channels:
            count = len(getattr(bone, channel))
            curves += [(bone_path(model.name, channel), index) for index in range(count)]
    return curves


def _turned_to_neighbors(
    channelbag: bpy.types.ActionChannelbag, columns: list[tuple[str, int, str, Array]], frames: Array
) -> dict[str, Array]:
    """Signs (K,) of the quaternions by data path, so that bones do not turn the long way round.

    A quaternion and its negative are the same posture, but Blender interpolates number by number.
    """
    signs: dict[str, Array] = {}
    for path in {path for path, *_ in columns if path.endswith("rotation_quaternion")}:
        values = np.stack([column for other, _, _, column in columns if other == path])  # (4, K)
        curves = [channelbag.fcurves.find(path, index=index) for index in range(len(values))]
        if all(curve is not None and len(curve.keyframe_points) for curve in curves):
            there = np.array([[curve.evaluate(float(frame)) for frame in frames] for curve in curves])
            signs[path] = np.where(np.sum(values * there, axis=0) < 0.0, -1.0, 1.0)
    return signs
