"""What operators need before they can run, as sentences for their tooltips."""

from collections.abc import Callable

import bpy

from .keyed_frames import invalidate_keyed_frames, keyframes_of
from .running_jobs import job_is_running
from .takes import find_take

Requirement = Callable[[bpy.types.Context], str | None]


def footage(context: bpy.types.Context) -> str | None:
    """A clip is loaded."""
    take = find_take(context.scene)
    return None if take and take.clip else "Load the footage or open a take first"


def camera(context: bpy.types.Context) -> str | None:
    """The footage's camera is known."""
    take = find_take(context.scene)
    return None if take and take.camera else "Choose the camera that the footage was taken with first"


def actor(context: bpy.types.Context) -> str | None:
    """The scene has an actor."""
    take = find_take(context.scene)
    armature_object = take.armature if take else None
    if armature_object is None or armature_object.name not in context.scene.objects:
        return "Build the actor first, or choose its armature"
    if armature_object.library is not None:
        return "The actor is linked; make a library override of it first (Object > Library Override)"
    return None


def markers(context: bpy.types.Context) -> str | None:
    """There are markers."""
    take = find_take(context.scene)
    return None if take and len(take.markers) else "Add the markers that the performer wears first"


def picked_color(context: bpy.types.Context) -> str | None:
    """A marker was given a color."""
    take = find_take(context.scene)
    picked = take is not None and any(marker.is_picked for marker in take.markers)
    return None if picked else "Pick the color of a marker first"


def all_colors(context: bpy.types.Context) -> str | None:
    """Every marker was given a color."""
    take = find_take(context.scene)
    picked = take is not None and all(marker.is_picked for marker in take.markers)
    return None if picked else "Pick the colors of all markers first, or remove those that have none"


def keyframes(context: bpy.types.Context) -> str | None:
    """There is an Action with keyframes."""
    take = find_take(context.scene)
    return None if take and take.keyframe_action else "Pose the actor and store a keyframe first"


def two_keyframes(context: bpy.types.Context) -> str | None:
    """There are keyframes to find frames between."""
    take = find_take(context.scene)
    if take is None or take.keyframe_action is None:
        return keyframes(context)
    if len(keyframes_of(take)) == 1:
        invalidate_keyed_frames()  # a script may have set a key that Blender has not told of yet
    if len(keyframes_of(take)) == 1:
        return "Store a keyframe at another frame first; there is only one"
    return None


def matches(context: bpy.types.Context) -> str | None:
    """There are frames that a library gave postures."""
    take = find_take(context.scene)
    return None if take and len(take.matching.matches) else "Match a library first"


def motion(context: bpy.types.Context) -> str | None:
    """There is a reconstructed motion."""
    take = find_take(context.scene)
    return None if take and take.motion_action else "Reconstruct the motion first"


def turntable(context: bpy.types.Context) -> str | None:
    """There are views of the actor from other sides."""
    take = find_take(context.scene)
    return None if take and take.turntable.collection else "Set up the turntable first"


def weak_frames(context: bpy.types.Context) -> str | None:
    """There are frames worth another keyframe."""
    take = find_take(context.scene)
    if take is None or take.review.frame_count == 0:
        return "Reconstruct the motion first"
    return None if len(take.review.weak_frames) else "No frame needs another keyframe"


def scene_library(context: bpy.types.Context) -> str | None:
    """A keyframe library is made in this file."""
    return None if len(context.scene.keymark.libraries) else "Begin a keyframe library first"


def registered_library(context: bpy.types.Context) -> str | None:
    """There is a keyframe library at hand."""
    return None if len(context.window_manager.keymark_shelf.libraries) else "Import a keyframe library first"


def object_mode_possible(context: bpy.types.Context) -> str | None:
    """No object is being edited."""
    active = context.view_layer.objects.active
    return None if active is None or active.mode == "OBJECT" else "Leave the active object's mode first (Tab)"


def bones_editable(context: bpy.types.Context) -> str | None:
    """Nothing is in a mode from which bones cannot be changed."""
    active = context.view_layer.objects.active
    free = active is None or active.mode in ("OBJECT", "POSE")
    return None if free else "Leave the active object's mode first (Tab)"


def idle(context: bpy.types.Context) -> str | None:
    """None of Keymark's jobs runs."""
    return "Another of Keymark's jobs is running" if job_is_running(context) else None


def all_met(
    operator_class: type[bpy.types.Operator], context: bpy.types.Context, *needed: Requirement
) -> bool:
    """Whether everything is there; the first thing that is not becomes the tooltip."""
    for requirement in needed:
        sentence = requirement(context)
        if sentence is not None:
            operator_class.poll_message_set(sentence)
            return False
    return True
