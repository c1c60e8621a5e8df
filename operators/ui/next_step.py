"""What to do next with a take, from what costs nothing to look at."""

import bpy

from ..bridge.actions import existing_channelbag

FEWEST_KEYFRAMES = 2


def next_step(take: bpy.types.PropertyGroup) -> str:
    """A few words that fit in a narrow sidebar, to be translated where they are drawn."""
    if take.clip is None:
        return "Next: load the footage"
    if take.clip_state.missing:
        return "Next: find the clip's file"
    if not len(take.markers):
        return "Next: add the markers"
    if any(not marker.is_picked for marker in take.markers):
        return "Next: pick the markers' colors"
    if take.armature is None or take.armature.name not in take.id_data.objects:
        return "Next: build the actor"
    count = posed_count(take)
    if not count and not len(take.proposals):
        return "Next: propose keyframes"
    if count < FEWEST_KEYFRAMES:
        return "Next: pose and store keyframes"
    if take.motion_action is None:
        return "Next: reconstruct the motion"
    return "Next: review, or finish"


def posed_count(take: bpy.types.PropertyGroup) -> int:
    """How many keys the first curve of the take's keyframes has: storing a pose keys every curve."""
    if take.keyframe_action is None or take.armature is None:
        return 0
    channelbag = existing_channelbag(take.keyframe_action, take.armature)
    if channelbag is None or not len(channelbag.fcurves):
        return 0
    return len(channelbag.fcurves[0].keyframe_points)
