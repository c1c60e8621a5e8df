"""The Action that is posed in: it must be the one that animates the actor while the animator poses."""

import bpy

from ..bridge.actions import assign_action
from ..bridge.object_space import evaluated


def shows_keyframes(take: bpy.types.PropertyGroup) -> bool:
    """Whether nothing but the keyframes animates the actor."""
    data = take.armature.animation_data
    return data is None or data.action is None or data.action == take.keyframe_action


def show_keyframes(take: bpy.types.PropertyGroup) -> bool:
    """Let the keyframes animate the actor instead of the motion; whether anything was changed.

    A new Action is evaluated once, at once, so that what is posed afterwards stays.
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
    """An empty Action for keyframes, kept even while the motion's Action is the one in use."""
    action = bpy.data.actions.new(f"{armature_object.name} Keyframes")
    action.use_fake_user = True
    return action
