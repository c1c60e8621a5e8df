"""Keying the actor's pose: the keyframe is posed from then on, and found ones around it are improved."""

import bpy

from ...core.body.human import HUMAN
from ..bridge.actions import assign_action
from ..matching.improve_neighbors import improve_neighbors
from ..shell.contradictions import note_contradictions
from ..shell.keyed_frames import invalidate_keyed_frames


def key_pose(context: bpy.types.Context, take: bpy.types.PropertyGroup) -> int:
    """Key the actor's pose as it stands, in the take's keyframe Action at the current frame.

    Args:
        context: Its scene holds the take.
        take: The take, with an actor and a keyframe Action.

    Returns:
        How many found keyframes around it were posed anew.

    Raises:
        InputError: A bone is missing.
    """
    from ..bridge.keyframes import store_pose

    frame = context.scene.frame_current_final
    store_pose(take.armature, take.keyframe_action, HUMAN, frame)
    assign_action(take.armature, take.keyframe_action)
    note_contradictions(take, frame, ())
    take.offered.candidates.clear()
    invalidate_keyed_frames()
    return improve_neighbors(context, take, frame)
