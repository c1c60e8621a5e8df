"""Requirements of operators: a function returns None if met, else the tooltip that says what to do first."""

from collections.abc import Callable

import bpy

from ..bridge.actor_bones import is_actor, missing_bones
from ..bridge.keys import keys_changed
from .job_progress import job_is_running
from .keyed_frames import keyframes_of
from .takes import find_take, has_lost_actor, present_actor

Requirement = Callable[[bpy.types.Context], str | None]


def of_take(has: Callable[[bpy.types.PropertyGroup], object], otherwise: str) -> Requirement:
    """Something that there must be a take with."""

    def requirement(context: bpy.types.Context) -> str | None:
        take = find_take(context.scene)
        return None if take is not None and has(take) else otherwise

    return requirement


footage = of_take(lambda take: take.clip, "Load the footage or open a take first")
camera = of_take(lambda take: take.camera, "Choose the camera that the footage was taken with first")
markers = of_take(lambda take: len(take.markers), "Add the markers that the performer wears first")
picked_color = of_take(
    lambda take: any(marker.is_picked for marker in take.markers), "Pick the color of a marker first"
)
keyframes = of_take(lambda take: take.keyframe_action, "Pose the actor and store a keyframe first")
matches = of_take(lambda take: len(take.matching.matches), "Find keyframes first (Pose All)")
motion = of_take(lambda take: take.motion_action, "Reconstruct the motion first")


def actor(context: bpy.types.Context) -> str | None:
    """The take's actor is in the scene and can be edited."""
    take = find_take(context.scene)
    if take is not None and has_lost_actor(take):
        return "Bring the deleted actor back first, in the step Performer"
    armature_object = present_actor(take) if take else None
    if armature_object is None:
        return "Build the actor first, or choose its armature"
    if not is_actor(armature_object):
        return (
            f"'{armature_object.name}' is no actor of Keymark's, as it lacks "
            f"{', '.join(missing_bones(armature_object)[:3])}; build an actor, and choose "
            f"'{armature_object.name}' in the step Character"
        )
    if armature_object.library is not None:
        return "The actor is linked; make a library override of it first (Object > Library Override)"
    return None


def all_colors(context: bpy.types.Context) -> str | None:
    """Every marker that is followed has a color."""
    take = find_take(context.scene)
    if take is None or not take.follow.use_markers or all(marker.is_picked for marker in take.markers):
        return None
    return "Pick the colors of all markers first, or remove those that have none"


def two_keyframes(context: bpy.types.Context) -> str | None:
    """The take has at least two keyframes, or a motion from elsewhere."""
    take = find_take(context.scene)
    if take is not None and take.follow.reference and take.method == "map":
        return None  # the motion from elsewhere has keyframes of its own
    if take is None or take.keyframe_action is None:
        return keyframes(context)
    if len(keyframes_of(take)) == 1:
        keys_changed()  # a script may have set a key for which Blender has called no handler yet
    if len(keyframes_of(take)) == 1:
        return "Store a keyframe at another frame first; there is only one"
    return None


def weak_frames(context: bpy.types.Context) -> str | None:
    """The review found frames worth another keyframe."""
    take = find_take(context.scene)
    if take is None or take.review.frame_count == 0:
        return "Reconstruct the motion first"
    return None if len(take.review.weak_frames) else "No frame needs another keyframe"


def registered_library(context: bpy.types.Context) -> str | None:
    """The registry has a keyframe library."""
    there = len(context.window_manager.keymark_shelf.libraries)
    return None if there else "Load a keyframe library first"


def object_mode_possible(context: bpy.types.Context) -> str | None:
    """The active object is in Object Mode, in which Blender adds objects."""
    active = context.view_layer.objects.active
    return None if active is None or active.mode == "OBJECT" else "Leave the active object's mode first (Tab)"


def bones_editable(context: bpy.types.Context) -> str | None:
    """The active object is in Object or Pose Mode, from which bones can be edited."""
    active = context.view_layer.objects.active
    free = active is None or active.mode in ("OBJECT", "POSE")
    return None if free else "Leave the active object's mode first (Tab)"


def idle(context: bpy.types.Context) -> str | None:
    """No job of Keymark's runs."""
    return (
        "Another of Keymark's jobs is running; wait for it, or stop it with Esc"
        if job_is_running(context)
        else None
    )


def all_met(
    operator_class: type[bpy.types.Operator], context: bpy.types.Context, *requirements: Requirement
) -> bool:
    """Whether all requirements are met; the sentence of the first unmet one becomes the tooltip."""
    for requirement in requirements:
        sentence = requirement(context)
        if sentence is not None:
            operator_class.poll_message_set(sentence)
            return False
    return True
