"""Adding an actor to a scene the way Blender adds objects: selected, active, and known to the panel."""

import bpy

from ..core.body.kinematics import Body
from .bridge.armature import build_armature


def add_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup, body: Body) -> bpy.types.Object:
    """Build the armature, named after the take; it becomes its actor, without keyframes or motion yet."""
    scene, layer = context.scene, context.view_layer
    for selected in list(layer.objects.selected):
        selected.select_set(False, view_layer=layer)
    armature_object = build_armature(scene, body, f"{take.name} Actor")
    armature_object.select_set(True, view_layer=layer)
    layer.objects.active = armature_object
    take.armature = armature_object
    take.keyframe_action = take.motion_action = None
    return armature_object


def new_keyframe_action(armature_object: bpy.types.Object) -> bpy.types.Action:
    """An empty Action for keyframes, kept even while the motion's Action is the one in use."""
    action = bpy.data.actions.new(f"{armature_object.name} Keyframes")
    action.use_fake_user = True
    return action
