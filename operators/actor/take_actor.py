"""A take's actor in its scene: built, sized, placed, and brought back with its keyframes and its motion."""

from contextlib import suppress

import bpy
from bpy.types import Context, Object, PropertyGroup, Scene
from mathutils import Matrix, Vector

from ...core.body.actor import Actor
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.errors import InputError
from ..bridge.actions import action_of
from ..bridge.actor_bones import hips_at_rest, is_actor
from ..bridge.armature import build_armature, set_lengths
from ..follow.evidence import scene_evidence
from ..shell.notes import give_notices
from ..shell.results import reading_of
from ..shell.take_state import TakeState
from ..shell.takes import footage_of
from .properties import LENGTHS, SIDED, panel_lengths


def restore_actor(context: Context, take: PropertyGroup) -> None:
    """Bring an actor back, selected: the deleted one, one that its Actions move, or one of these lengths."""
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
    take.armature = armature_object  # its update animates it and calls `show_lengths`
    return armature_object


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


def performers_stance(scene: Scene, take: PropertyGroup, body: Body) -> tuple[Posture, bool] | None:
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
