"""A take's keyframe Action: it must animate the actor while the animator poses."""

import bpy

from ..bridge.actions import assign_action
from ..bridge.object_space import evaluated


def shows_keyframes(take: bpy.types.PropertyGroup) -> bool:
    """Whether the actor is animated by its keyframe Action, or by none."""
    data = take.armature.animation_data
    return data is None or data.action is None or data.action == take.keyframe_action


def show_keyframes(take: bpy.types.PropertyGroup) -> bool:
    """Let the keyframe Action animate the actor instead of the motion; return whether that changed anything.

    The new Action is evaluated at once: evaluated later, it would overwrite a pose set in between.
    """
    data = take.armature.animation_data
    if data is None or data.action == take.keyframe_action:
        return False
    if take.keyframe_action is None:
        data.action = None
    else:
        assign_action(take.armature, take.keyframe_action)
    evaluated(take.armature)
    return True


def new_keyframe_action(armature_object: bpy.types.Object) -> bpy.types.Action:
    """Return an empty Action for keyframes, with a fake user: kept while the motion's is in use."""
    action = bpy.data.actions.new(f"{armature_object.name} Keyframes")
    action.use_fake_user = True
    return action
