"""Frames of a scene: those that show a clip's frames, and other frames or Actions evaluated for a while.

Blender discards poses without keys as soon as it evaluates a frame: the context managers here restore them.
"""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from math import floor

import numpy as np
from bpy.types import Action, Object, Scene
from numpy.typing import ArrayLike

from ...core.arrays import Array, IndexArray
from ...core.markers.region_tracks import is_variable_frame_rate
from ...core.progress import Part
from .actions import assign_action
from .actor_bones import evaluated

Pose = dict[str, list[tuple[float, ...]]]  # values of all channels, by bone
CHANNELS = ("location", "rotation_quaternion", "rotation_axis_angle", "rotation_euler", "scale")
LOOKS_AT_ONCE = 40  # frames looked at in a row: putting the scene back takes as long as five


def scene_frames(time_s: Array, first: float, rate: float) -> Array:
    """Scene frames (F,) of a clip's, whose times are (F,) [s]: whole steps, others if its rate varies."""
    steps = time_s * rate if is_variable_frame_rate(time_s) else np.arange(len(time_s), dtype=np.float64)
    return np.asarray(first + steps)


def shown_index(frames: Array, at: ArrayLike) -> IndexArray:
    """Index of the clip's frame, of (F,), shown at scene frames (...); -1 before the clip and after it."""
    frame = np.asarray(at, dtype=np.float64)
    index = np.searchsorted(frames, frame + 1e-3, side="right") - 1
    return np.asarray(np.where(frame < frames[-1] + 1.0, index, -1), dtype=np.intp)


def show_frame(scene: Scene, frame: float) -> None:
    """Let the scene show a frame, which may lie between whole ones."""
    whole = floor(frame)
    scene.frame_set(whole, subframe=frame - whole)


@contextmanager
def at_scene_frame(scene: Scene) -> Iterator[Callable[[float], None]]:
    """Yield a function that evaluates the scene at a frame; then its frame and unkeyed poses are restored."""
    before = scene.frame_current, scene.frame_subframe
    armatures = [one for one in scene.objects if one.type == "ARMATURE" and one.is_editable]
    poses = [(actor, pose_of(actor)) for actor in armatures if actor.animation_data is not None]
    try:
        yield lambda frame: show_frame(scene, frame)
    finally:
        scene.frame_set(before[0], subframe=before[1])
        for actor, pose in poses:
            restore_pose(actor, pose)


def each_frame(
    scene: Scene,
    frames: Array,
    meanwhile: Callable[[], AbstractContextManager[None]],
    look: Callable[[], None],
) -> Part[None]:
    """Look at scene frames (F,), with what `meanwhile` does; while it yields, the scene is as it was."""
    for first in range(0, len(frames), LOOKS_AT_ONCE):
        with at_scene_frame(scene) as go_to, meanwhile():
            for frame in frames[first : first + LOOKS_AT_ONCE]:
                go_to(frame)
                look()
        yield min(first + LOOKS_AT_ONCE, len(frames)) / len(frames)


@contextmanager
def showing_action(armature_object: Object, action: Action | None) -> Iterator[None]:
    """Assign an Action, or none, to the armature meanwhile; then restore its Action and unkeyed pose."""
    data = armature_object.animation_data_create()
    before = data.action, data.action_slot
    pose = pose_of(armature_object)
    if action is None:
        data.action = None
    elif data.action != action:
        assign_action(armature_object, action)
    try:
        yield
    finally:
        if data.action != before[0]:
            data.action = before[0]
            if before[1] is not None:
                data.action_slot = before[1]
            evaluated(armature_object)  # a new Action is evaluated once, which would undo the unkeyed changes
        restore_pose(armature_object, pose)


def pose_of(armature_object: Object) -> Pose:
    """All channels of an armature's bones as they stand, keyed or not."""
    bones = armature_object.pose.bones
    return {bone.name: [tuple(getattr(bone, channel)) for channel in CHANNELS] for bone in bones}


def restore_pose(armature_object: Object, pose: Pose) -> None:
    """Give an armature's bones the channels that `pose_of` had."""
    for name, values in pose.items():
        bone = armature_object.pose.bones[name]
        for channel, value in zip(CHANNELS, values, strict=True):
            setattr(bone, channel, value)
