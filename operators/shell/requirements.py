"""Requirements of operators: a function returns None if met, else the tooltip that says what to do first."""

from collections.abc import Callable

import bpy

from ..bridge.actor_bones import is_actor, missing_bones
from .job_progress import job_is_running
from .keyed_frames import invalidate_keyed_frames, keyframes_of
from .takes import find_take, has_lost_actor, present_actor

MOST_NAMED = 3  # missing bones that a sentence names

Requirement = Callable[[bpy.types.Context], str | None]


def footage(context: bpy.types.Context) -> str | None:
    """The take has a clip."""
    take = find_take(context.scene)
    return None if take and take.clip else "Load the footage or open a take first"


def camera(context: bpy.types.Context) -> str | None:
    """The take has a camera."""
    take = find_take(context.scene)
    return None if take and take.camera else "Choose the camera that the footage was taken with first"


def actor(context: bpy.types.Context) -> str | None:
    """The take's actor is in the scene and can be edited."""
    take = find_take(context.scene)
    if take is not None and has_lost_actor(take):
        return "Bring the deleted actor back first, in the step Actor"
    armature_object = present_actor(take) if take else None
    if armature_object is None:
        return "Build the actor first, or choose its armature"
    if not is_actor(armature_object):
        return (
            f"'{armature_object.name}' is no actor of Keymark's, as it lacks "
            f"{', '.join(missing_bones(armature_object)[:MOST_NAMED])}; build an actor, and choose "
            f"'{armature_object.name}' in the step Character"
        )
    if armature_object.library is not None:
        return "The actor is linked; make a library override of it first (Object > Library Override)"
    return None


def markers(context: bpy.types.Context) -> str | None:
    """The take has markers."""
    take = find_take(context.scene)
    return None if take and len(take.markers) else "Add the markers that the performer wears first"


def picked_color(context: bpy.types.Context) -> str | None:
    """At least one marker has a color."""
    take = find_take(context.scene)
    picked = take is not None and any(marker.is_picked for marker in take.markers)
    return None if picked else "Pick the color of a marker first"


def all_colors(context: bpy.types.Context) -> str | None:
    """Every marker that is followed has a color."""
    take = find_take(context.scene)
    if take is None or not take.follow.use_markers or all(marker.is_picked for marker in take.markers):
        return None
    return "Pick the colors of all markers first, or remove those that have none"


def keyframes(context: bpy.types.Context) -> str | None:
    """The take has a keyframe Action."""
    take = find_take(context.scene)
    return None if take and take.keyframe_action else "Pose the actor and store a keyframe first"


def two_keyframes(context: bpy.types.Context) -> str | None:
    """The take has at least two keyframes."""
    take = find_take(context.scene)
    if take is None or take.keyframe_action is None:
        return keyframes(context)
    if len(keyframes_of(take)) == 1:
        invalidate_keyed_frames()  # a script may have set a key for which Blender has called no handler yet
    if len(keyframes_of(take)) == 1:
        return "Store a keyframe at another frame first; there is only one"
    return None


def matches(context: bpy.types.Context) -> str | None:
    """The take has found keyframes."""
    take = find_take(context.scene)
    return None if take and len(take.matching.matches) else "Find keyframes first (Pose All)"


def motion(context: bpy.types.Context) -> str | None:
    """The take has a reconstructed motion."""
    take = find_take(context.scene)
    return None if take and take.motion_action else "Reconstruct the motion first"


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
