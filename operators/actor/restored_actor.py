"""Bringing an actor back that was deleted or replaced: its keyframes and its motion belong to the take."""

import bpy
from mathutils import Matrix, Vector

from ...core.body.actor import Actor
from ...core.body.kinematics import Body
from ..bridge.actions import assign_action
from ..bridge.actor_bones import hips_at_rest, is_actor
from ..bridge.armature import build_armature
from ..shell.takes import kept_actions, present_actor
from .properties import panel_lengths


def restore_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup) -> None:
    """Bring a take's actor back into the scene, selected.

    One that was deleted in the viewport is still in the file and is linked again. Else an armature of the
    scene that the take's Actions animate is the actor; else one is built of the lengths in the panel, with
    the hips at rest where they were, so that all keys put it where they put the other.
    """
    scene = context.scene
    if take.armature is not None:
        if present_actor(take) is None:
            scene.collection.objects.link(take.armature)
    else:
        actions = kept_actions(take)
        found = next((each for each in scene.objects if is_actor(each) and _action_of(each) in actions), None)
        if found is None:
            new_actor(context, take, Body(Actor(panel_lengths(take.lengths))))
            return
        take.armature = found
    select_alone(context, take.armature)


def new_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup, body: Body) -> bpy.types.Object:
    """Build an armature, selected, as a take's actor; what the take has of another animates it."""
    leave_mode(context)
    armature_object = build_armature(context.scene, body, f"{take.name} Actor")
    if kept_actions(take) and any(take.rest_hips):
        away = Vector(take.rest_hips) - Vector(hips_at_rest(armature_object))
        armature_object.data.transform(Matrix.Translation(away))
    select_alone(context, armature_object)
    take.armature = armature_object  # its update calls `reattach`
    return armature_object


def reattach(take: bpy.types.PropertyGroup) -> None:
    """Let a take's motion, or else its keyframes, animate an actor that nothing animates yet."""
    actions = [action for action in (take.motion_action, take.keyframe_action) if action is not None]
    if take.armature is not None and actions and _action_of(take.armature) is None:
        assign_action(take.armature, actions[0])


def leave_mode(context: bpy.types.Context) -> None:
    """Leave the mode of the active object, as Blender does before it adds objects."""
    active = context.view_layer.objects.active
    if active is not None and active.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def select_alone(context: bpy.types.Context, armature_object: bpy.types.Object) -> None:
    """Select an armature alone, and make it active."""
    leave_mode(context)
    layer = context.view_layer
    for selected in list(layer.objects.selected):
        selected.select_set(False, view_layer=layer)
    armature_object.select_set(True, view_layer=layer)
    layer.objects.active = armature_object


def _action_of(animated: bpy.types.Object) -> bpy.types.Action | None:
    data = animated.animation_data
    return None if data is None else data.action
