"""A corrected pose: what is shown now, and how a correction is set and kept."""

from typing import TYPE_CHECKING

import bpy

from ...core.body.human import HUMAN
from ..shell.keyed_frames import has_frame, invalidate_keyed_frames, keyframes_of
from ..shell.keyframe_action import show_keyframes
from ..shell.redraw import redraw_footage
from ..shell.takes import footage_of
from .key_pose import key_pose

if TYPE_CHECKING:
    from ...core.body.kinematics import Body
    from ...core.body.posture import Posture
    from ...core.footage.camera import Camera

DRAGGING = "keymark.drag_joints"


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


def set_corrected(
    operator: bpy.types.Operator,
    context: bpy.types.Context,
    take: bpy.types.PropertyGroup,
    posture: "Posture",
) -> None:
    """Give the actor a corrected posture; where this frame holds a keyframe, that is the new one at once.

    A found keyframe counts as posed from then on, and the operator reports how many around it were improved.
    """
    from ..bridge.pose import write_posture

    show_keyframes(take)
    write_posture(take.armature, posture)
    invalidate_keyed_frames()
    redraw_footage(context)
    if take.keyframe_action is None or not has_frame(keyframes_of(take), context.scene.frame_current_final):
        return
    improved = key_pose(context, take)
    if improved:
        operator.report({"INFO"}, f"{improved} found keyframes around this one were posed anew")
