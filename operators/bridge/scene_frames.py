"""Going through a scene's frames, or an armature's Actions, and coming back with everything as it was."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import floor

import bpy

from .actions import assign_action
from .object_space import evaluated

CHANNELS = ("location", "rotation_quaternion", "rotation_axis_angle", "rotation_euler", "scale")


@contextmanager
def at_scene_frame(scene: bpy.types.Scene) -> Iterator[Callable[[float], None]]:
    """Yield a function that evaluates the scene at a frame, fractional ones too; then go back."""
    before = scene.frame_current, scene.frame_subframe

    def go_to(frame: float) -> None:
        whole = floor(frame)
        scene.frame_set(whole, subframe=frame - whole)

    try:
        yield go_to
    finally:
        scene.frame_set(before[0], subframe=before[1])


@contextmanager
def showing_action(armature_object: bpy.types.Object, action: bpy.types.Action | None) -> Iterator[None]:
    """Let `action`, or nothing, animate the armature meanwhile; then give back Action and unkeyed pose."""
    data = armature_object.animation_data_create()
    before = data.action, data.action_slot
    bones = armature_object.pose.bones
    pose = {bone.name: [tuple(getattr(bone, channel)) for channel in CHANNELS] for bone in bones}
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
        for name, values in pose.items():
            for channel, value in zip(CHANNELS, values, strict=True):
                setattr(bones[name], channel, value)
