"""Channel values read from an Action, the animator's changes included, and the final Action written."""

from collections.abc import Generator, Mapping, Sequence

import bpy
import numpy as np

from ...core.arrays import Array, BoolArray, IndexArray
from ...core.body.kinematics import Body, Extremities
from ...core.body.posture import Posture
from ...core.body.rotations import continuous_quaternions
from ...core.body.skeleton import Skeleton
from ...core.errors import InputError
from ...core.finish.hermite import Spline
from ...core.finish.rig import Rig, RigPose, channel_count
from .actions import channelbag_for, existing_channelbag
from .actor_lengths import skeleton_bones
from .fcurves import moved_paths, posture_columns
from .keyframes import keyed_frames, untouched_frames
from .keys import copy_keys, ensure_fcurve, write_linear_keys, write_smooth_keys
from .review_curves import is_review_curve
from .rotation_modes import ALL_PATHS, bone_path, posture_from_frames, rotation_path

Channel = tuple[int, int, str, int]
"""Index of a bone in the rig, column of its values, data path and array index of the property."""

CHANGED_BY_FEET = ("pelvis", "thigh", "shin")
SMALLEST_LENGTH = 1e-9
ROUNDING = 1e-3
"""Keys this near to a whole frame [frames] lie on it."""


def rig_channels(rig: Rig) -> tuple[Channel, ...]:
    """The armature's property for every column of every bone's values."""
    found: list[Channel] = []
    for bone, model in enumerate(rig.bones):
        count = channel_count(model.mode)
        path = bone_path(model.name, rotation_path(model.mode))
        found += [(bone, index, path, index) for index in range(count)]
        if model.location_axes is not None:
            found += [(bone, count + i, bone_path(model.name, "location"), i) for i in range(3)]
    return tuple(found)


def motion_frames(armature_object: bpy.types.Object, action: bpy.types.Action, body: Body) -> Array:
    """(F,) whole scene frames from the first to the last key of an Action's motion.

    Raises:
        InputError: It has fewer than two.
    """
    channelbag = existing_channelbag(action, armature_object)
    wanted = set(moved_paths(armature_object, body.skeleton))
    curves = channelbag.fcurves if channelbag is not None else ()
    keyed = [curve for curve in curves if curve.data_path in wanted and not curve.is_empty]
    ranges = [curve.range() for curve in keyed]
    first = int(np.ceil(min((r[0] for r in ranges), default=0.0) - ROUNDING))
    last = int(np.floor(max((r[1] for r in ranges), default=0.0) + ROUNDING))
    if last <= first:
        raise InputError(
            f"Action '{action.name}' has no motion of '{armature_object.name}' over two frames or more; "
            "reconstruct the motion first"
        )
    return np.arange(first, last + 1, dtype=np.float64)


def read_values(
    armature_object: bpy.types.Object, action: bpy.types.Action, rig: Rig, frames: Array
) -> Generator[float, None, list[Array]]:
    """Evaluate an Action's curves at scene frames, bone by bone; the scene is not touched.

    Channels without a curve, or with a muted one, have the value that the armature has now, as when Blender
    plays the Action.

    Args:
        armature_object: The actor.
        action: The motion, with the animator's changes.
        rig: The actor as `read_rig` finds it.
        frames: (F,) scene frames.

    Yields:
        The fraction done.

    Returns:
        Values as in `Rig`: (F, C) a bone; quaternions of unit length and without jumps of sign.
    """
    channelbag = existing_channelbag(action, armature_object)
    channels = rig_channels(rig)
    columns: list[list[Array]] = [[] for _ in rig.bones]
    for number, (bone, _, path, index) in enumerate(channels):
        fcurve = channelbag.fcurves.find(path, index=index) if channelbag is not None else None
        if fcurve is None or fcurve.mute:
            unkeyed = armature_object.path_resolve(path)[index]
            columns[bone].append(np.full(len(frames), float(unkeyed)))
        else:
            columns[bone].append(np.array([fcurve.evaluate(frame) for frame in frames], dtype=np.float64))
        yield (number + 1) / len(channels)
    values = [np.column_stack(column) for column in columns]
    for bone, model in enumerate(rig.bones):
        if model.mode == "QUATERNION":
            values[bone][:, :4] = _unit_quaternions(values[bone][:, :4])
    return values


def _unit_quaternions(quaternions: Array) -> Array:
    length = np.linalg.norm(quaternions, axis=1, keepdims=True)
    unit = np.where(
        length > SMALLEST_LENGTH, quaternions / np.maximum(length, SMALLEST_LENGTH), [1.0, 0, 0, 0]
    )
    return continuous_quaternions(unit)


def shown_postures(armature_object: bpy.types.Object, rig: Rig, shown: RigPose, body: Body) -> Posture:
    """The postures nearest to a rig's poses, a batch of F."""
    models = skeleton_bones(armature_object, body.skeleton)
    turns = {bone.name: shown.rotation[index] for index, bone in enumerate(rig.bones)}
    turns |= {model.name: turns[str(model.parent)] for model in models if model.name not in turns}
    hips = shown.points[:, rig.point_slices[0].start] - body.offsets[0]
    return posture_from_frames(body.skeleton, models, turns, hips)


def with_planted_legs(
    armature_object: bpy.types.Object, rig: Rig, values: Sequence[Array], planted: Posture
) -> list[Array]:
    """Values with hips and legs replaced by those of other postures; the rest stays."""
    stored = {(path, index): column for path, index, _, column in posture_columns(armature_object, planted)}
    changed = [column.copy() for column in values]
    for bone, column, path, index in rig_channels(rig):
        if rig.bones[bone].name.partition(".")[0] in CHANGED_BY_FEET:
            changed[bone][:, column] = stored[path, index]
    return changed


def with_turned_extremities(
    armature_object: bpy.types.Object,
    rig: Rig,
    values: Sequence[Array],
    posture: Posture,
    extremities: Extremities,
    where: Mapping[str, BoolArray],
) -> list[Array]:
    """Values with hands and feet turned anew; the rest stays.

    Args:
        armature_object: The actor.
        rig: The actor, with the hands and feet as bones.
        values: What each bone of the rig holds, (F, C).
        posture: A batch of F postures.
        extremities: Its hands and feet.
        where: (F,) by name of hand or foot: in which frames.
    """
    columns = posture_columns(armature_object, posture, extremities)
    stored = {(path, index): column for path, index, _, column in columns}
    changed = [column.copy() for column in values]
    for bone, column, path, index in rig_channels(rig):
        rows = where.get(rig.bones[bone].name)
        if rows is not None:
            changed[bone][rows, column] = stored[path, index][rows]
    for bone, model in enumerate(rig.bones):
        if model.name in where and model.mode == "QUATERNION":
            changed[bone][:, :4] = _unit_quaternions(changed[bone][:, :4])
    return changed


def largest_leg_distance_m(rig: Rig, shown: RigPose, body: Body, posture: Posture) -> float:
    """The largest distance of a leg's joint or end between a rig's poses and postures [m]."""
    pose = body.pose(posture)
    worst = 0.0
    for index, bone in enumerate(rig.bones):
        if bone.name.partition(".")[0] in CHANGED_BY_FEET:
            end = body.segment_ends(pose, bone.name)[1]
            there = shown.points[:, rig.point_slices[index].start + 1]
            worst = max(worst, float(np.linalg.norm(end - there, axis=-1).max()))
    return worst


def posed_indices(
    armature_object: bpy.types.Object,
    keyframe_action: bpy.types.Action | None,
    skeleton: Skeleton,
    frames: Array,
) -> IndexArray:
    """Indices of the frames that the animator posed."""
    if keyframe_action is None:
        return np.zeros(0, dtype=np.intp)
    keyed = keyed_frames(armature_object, keyframe_action, skeleton)
    matched = untouched_frames(armature_object, keyframe_action, skeleton)
    posed = np.array(sorted(set(keyed) - set(matched)))
    return np.flatnonzero(np.isin(frames, np.round(posed)))


def write_final(
    armature_object: bpy.types.Object,
    source: bpy.types.Action,
    action: bpy.types.Action,
    body: Body,
    rig: Rig,
    frames: Array,
    motion: Sequence[Array] | Sequence[Spline],
) -> int:
    """Write a finished motion as ordinary keys, replacing all that the Action held for the actor.

    Args:
        armature_object: The actor.
        source: The Action the motion was read from; its other curves (posed hands and feet, properties) are
            copied, but for review curves.
        action: The final Action.
        body: The actor's body.
        rig: The actor as `read_rig` finds it.
        frames: (F,) scene frames, rising.
        motion: For each bone of the rig its values (F, C), keyed on every frame; or few keys.

    Returns:
        Number of keys on the bones' curves.
    """
    channelbag = channelbag_for(action, armature_object)
    for fcurve in list(channelbag.fcurves):
        channelbag.fcurves.remove(fcurve)
    count = 0
    for bone, column, path, index in rig_channels(rig):
        fcurve = ensure_fcurve(channelbag, path, index, rig.bones[bone].name)
        held = motion[bone]
        if isinstance(held, Spline):
            write_smooth_keys(fcurve, frames[held.keys], held.values[:, column], held.slopes[:, column])
        else:
            write_linear_keys(fcurve, frames, held[:, column])
        count += len(fcurve.keyframe_points)
    written = set(moved_paths(armature_object, body.skeleton))
    written |= {bone_path(bone.name, channel) for bone in rig.bones for channel in ALL_PATHS}
    given = existing_channelbag(source, armature_object)
    for fcurve in given.fcurves if given is not None else ():
        if fcurve.data_path not in written and not is_review_curve(fcurve):
            group = fcurve.group.name if fcurve.group is not None else armature_object.name
            copy_keys(fcurve, ensure_fcurve(channelbag, fcurve.data_path, fcurve.array_index, group))
    action.use_frame_range = True
    action.frame_start, action.frame_end = float(frames[0]), float(frames[-1])
    return count
