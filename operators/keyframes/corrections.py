"""A corrected pose: what is shown now, and how a correction is set and kept."""

from typing import TYPE_CHECKING

import bpy

from ...core.body.human import HUMAN
from ..bridge.actions import assign_action
from ..shell.job_progress import job_is_running
from ..shell.keyed_frames import has_frame, invalidate_keyed_frames, keyframes_of
from ..shell.keyframe_action import show_keyframes
from ..shell.redraw import redraw_footage
from ..shell.takes import footage_of

if TYPE_CHECKING:
    from ...core.body.kinematics import Body
    from ...core.body.posture import Posture
    from ...core.footage.camera import Camera

DRAGGING = "keymark.drag_joints"


def no_job(context: bpy.types.Context) -> str | None:
    """No job of Keymark's runs; poses may be corrected while joints are dragged."""
    running = job_is_running(context, besides=DRAGGING)
    return "Another of Keymark's jobs is running" if running else None


def shown_pose(take: bpy.types.PropertyGroup) -> "tuple[Body, Posture]":
    """The actor's sizes, and the posture that it shows now."""
    from ..bridge.actor_lengths import read_body
    from ..bridge.pose import read_posture

    body = read_body(take.armature, HUMAN)
    return body, read_posture(take.armature, body).posture


def camera_now(scene: bpy.types.Scene, take: bpy.types.PropertyGroup) -> "Camera":
    """The take's camera as it stands in the current frame.

    Raises:
        InputError: There is no camera or clip, or the camera is of an unsupported type.
    """
    import numpy as np

    from ..bridge.camera_from_scene import read_camera

    return read_camera(footage_of(scene, take), np.array([scene.frame_current_final]))


def set_corrected(context: bpy.types.Context, take: bpy.types.PropertyGroup, posture: "Posture") -> bool:
    """Give the actor a corrected posture; where this frame holds a keyframe, that is the new one at once.

    A found keyframe counts as posed from then on, and found ones around it are improved.

    Returns:
        Whether a keyframe was changed.
    """
    from ..bridge.keyframes import store_pose
    from ..bridge.pose import write_posture

    frame = context.scene.frame_current_final
    show_keyframes(take)
    write_posture(take.armature, posture)
    invalidate_keyed_frames()
    keyed = take.keyframe_action is not None and has_frame(keyframes_of(take), frame)
    if keyed:
        store_pose(take.armature, take.keyframe_action, HUMAN, frame)
        assign_action(take.armature, take.keyframe_action)
        invalidate_keyed_frames()
    redraw_footage(context)
    return keyed
