"""A take's keyframe Action: it must animate the actor while the animator poses."""

import bpy

from ...core.body.human import HUMAN
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
    straighten_unposed(take)
    if take.keyframe_action is None:
        data.action = None
    else:
        assign_action(take.armature, take.keyframe_action)
    evaluated(take.armature)
    return True


def straighten_unposed(take: bpy.types.PropertyGroup) -> None:
    """Put hands and feet back to rest where they stand as the motion that is shown has turned them.

    To be called before keyframes are stored or shown: nobody has posed these.
    """
    from ..bridge.extremity_curves import straighten_extremities

    data = take.armature.animation_data
    shown = None if data is None else data.action
    if shown is not None and shown in (take.motion_action, take.finish.action):
        frame = float(bpy.context.scene.frame_current_final)
        straighten_extremities(take.armature, HUMAN, shown, take.keyframe_action, frame)


def new_keyframe_action(armature_object: bpy.types.Object) -> bpy.types.Action:
    """Return an empty Action for keyframes, with a fake user: kept while the motion's is in use."""
    action = bpy.data.actions.new(f"{armature_object.name} Keyframes")
    action.use_fake_user = True
    return action
