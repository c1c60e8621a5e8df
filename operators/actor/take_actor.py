"""A take's actor in its scene: built, sized, placed, and brought back with its keyframes and its motion."""

from contextlib import suppress
from typing import TYPE_CHECKING

import bpy
from bpy.types import Context, Object, PropertyGroup, Scene
from mathutils import Matrix, Vector

from ...core.body.actor import Actor
from ...core.body.kinematics import Body
from ...core.errors import InputError
from ..bridge.actions import action_of, assign_action
from ..bridge.actor_bones import hips_at_rest, is_actor
from ..bridge.armature import build_armature, set_lengths
from ..follow.evidence import scene_evidence
from ..shell.notes import give_notices
from ..shell.results import reading_of
from ..shell.take_state import TakeState
from ..shell.takes import footage_of
from .properties import LENGTHS, SIDED, panel_lengths

if TYPE_CHECKING:
    from ...core.body.posture import Posture


def restore_actor(context: Context, take: PropertyGroup) -> None:
    """Bring a take's actor back into the scene, selected.

    One that was deleted in the viewport is still in the file. Else an armature that the take's Actions move
    is the actor; else one is built of the panel's lengths, its hips at rest where keys expect them.
    """
    scene = context.scene
    if take.armature is not None:
        if TakeState(take).actor is None:
            scene.collection.objects.link(take.armature)
    else:
        actions = TakeState(take).kept_actions
        found = next((each for each in scene.objects if is_actor(each) and action_of(each) in actions), None)
        if found is None:
            new_actor(context, take, Body(Actor(panel_lengths(take.lengths))))
            return
        take.armature = found
    select_alone(context, take.armature)


def new_actor(context: Context, take: PropertyGroup, body: Body) -> Object:
    """Build an armature, selected, as a take's actor; what the take has of another animates it."""
    leave_mode(context)
    armature_object = build_armature(context.scene, body, f"{take.name} Actor")
    if TakeState(take).kept_actions and any(take.rest_hips):
        away = Vector(take.rest_hips) - Vector(hips_at_rest(armature_object))
        armature_object.data.transform(Matrix.Translation(away))
    select_alone(context, armature_object)
    take.armature = armature_object  # its update calls `reattach` and `show_lengths`
    return armature_object


def reattach(take: PropertyGroup) -> None:
    """Let a take's motion, or else its keyframes, animate an actor that nothing animates yet."""
    actions = [action for action in (take.motion_action, take.keyframe_action) if action is not None]
    if take.armature is not None and actions and action_of(take.armature) is None:
        assign_action(take.armature, actions[0])


def leave_mode(context: Context) -> None:
    """Leave the mode of the active object, as Blender does before it adds objects."""
    active = context.view_layer.objects.active
    if active is not None and active.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def select_alone(context: Context, armature_object: Object) -> None:
    """Select an armature alone, and make it active."""
    leave_mode(context)
    layer = context.view_layer
    for selected in list(layer.objects.selected):
        selected.select_set(False, view_layer=layer)
    armature_object.select_set(True, view_layer=layer)
    layer.objects.active = armature_object


def size_actor(context: Context, take: PropertyGroup, body: Body) -> bool:
    """Give the take's actor, even a deleted one, a body's lengths, or build one; return if it had one."""
    if TakeState(take).has_lost_actor:
        restore_actor(context, take)
    elif take.armature is None:
        new_actor(context, take, body)
        return False
    set_lengths(take.armature, body)
    show_lengths(take, body)
    return True


def show_lengths(take: PropertyGroup, body: Body) -> None:
    """Set the lengths in the panel to a body's."""
    segments = body.actor.segments_m
    take.rest_hips = hips_at_rest(take.armature)
    give_notices(take, "actor", "lengths")  # of other lengths
    lengths = take.lengths
    apart = [abs(segments[f"{part}.L"] - segments[f"{part}.R"]) for part in SIDED]
    lengths.symmetric = max(apart) < 5e-4
    for name, own in LENGTHS.items():
        setattr(lengths, own, segments[name])


def performers_stance(scene: Scene, take: PropertyGroup, body: Body) -> "tuple[Posture, bool] | None":
    """Posture of a performer who stands in the footage's current frame, and if evidence located them."""
    from ..bridge.take_from_scene import frame_in_footage, posed_standing

    if take.clip is None or take.camera is None:
        return None
    regions = None
    try:
        frame = frame_in_footage(footage_of(scene, take), scene_evidence(take), reading_of(take))
        keypoints = frame.keypoints(body)
    except InputError:
        return None
    with suppress(InputError):  # a color that is not found yet must not prevent building the actor
        regions = frame.regions() if frame.styles else None
    seen = regions is not None and bool(regions.visible.any())
    seen |= bool(keypoints.frame(frame.index).seen.any())
    return posed_standing(frame, body, regions, keypoints), seen


def has_keyframes(take: PropertyGroup) -> bool:
    """Whether the animator has keyed the actor already, so that its pose must stay."""
    return take.keyframe_action is not None and len(take.keyframe_action.slots) > 0
