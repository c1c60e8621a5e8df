"""What must hold before an operator can run, by names as in `need.footage`: else a sentence, its tooltip."""

from collections.abc import Callable

import bpy
from bpy.types import Context

from ..bridge.actor_bones import is_actor, missing_bones
from ..bridge.keys import keys_changed
from .job_progress import job_is_running
from .take_state import TakeState

Requirement = Callable[[bpy.types.Context, TakeState | None], str | None]
"""Of the context, and the state of the active take; None without a take."""


def of_take(has: Callable[[TakeState], object], otherwise: str) -> Requirement:
    """Something that there must be a take with."""
    return lambda _, state: None if state is not None and has(state) else otherwise


footage = of_take(lambda state: state.take.clip, "Load the footage or open a take first")
camera = of_take(lambda state: state.take.camera, "Choose the camera that the footage was taken with first")
markers = of_take(lambda state: len(state.take.markers), "Add the markers that the performer wears first")
picked_color = of_take(
    lambda state: any(marker.is_picked for marker in state.take.markers), "Pick the color of a marker first"
)
keyframes = of_take(lambda state: state.take.keyframe_action, "Pose the actor and store a keyframe first")
matches = of_take(lambda state: len(state.take.matching.matches), "Find keyframes first (Pose All)")
motion = of_take(lambda state: state.take.motion_action, "Reconstruct the motion first")
keypoint_files = of_take(lambda state: len(state.take.follow.files), "Load keypoints first")


def actor(_context: Context, state: TakeState | None) -> str | None:
    """The take's actor is in the scene and can be edited."""
    if state is not None and state.has_lost_actor:
        return "Bring the deleted actor back first, in the step Performer"
    armature_object = None if state is None else state.actor
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


def any_actor(context: Context, state: TakeState | None) -> str | None:
    """The take has an actor, or had one."""
    return None if state is not None and state.has_lost_actor else actor(context, state)


def anything_to_follow(_context: Context, state: TakeState | None) -> str | None:
    """The take follows markers, keypoints, tracks or contours."""
    if state is None or state.has_points or state.has_contours:
        return None  # a take without footage says so itself
    if state.take.follow.use_contours and state.take.camera is not None:
        return "Load keypoints, assign tracks or add markers first: contours need a camera that stands still"
    return "Switch on the contours, load keypoints, assign tracks or add markers first (step Performer)"


def points_to_follow(_context: Context, state: TakeState | None) -> str | None:
    """The take follows markers, keypoints or tracks; contours alone are not enough."""
    if state is None or state.has_points:
        return None
    return "Load keypoints, assign tracks or add markers first; this needs more than contours"


def all_colors(_context: Context, state: TakeState | None) -> str | None:
    """Every marker that is followed has a color."""
    lacking = "Pick the colors of all markers first, or remove those that have none"
    return lacking if state is not None and state.lacks_colors else None


def two_keyframes(context: Context, state: TakeState | None) -> str | None:
    """The take has at least two keyframes, or a motion from elsewhere."""
    if state is not None and state.take.follow.reference and state.take.method == "map":
        return None  # the motion from elsewhere has keyframes of its own
    if state is None or state.take.keyframe_action is None:
        return keyframes(context, state)
    if len(state.keyed.all) == 1:
        keys_changed()  # a script may have set a key for which Blender has called no handler yet
        if len(TakeState(state.take).keyed.all) == 1:
            return "Store a keyframe at another frame first; there is only one"
    return None


def weak_frames(_context: Context, state: TakeState | None) -> str | None:
    """The review found frames worth another keyframe."""
    if state is None or state.take.review.frame_count == 0:
        return "Reconstruct the motion first"
    return None if len(state.take.review.weak_frames) else "No frame needs another keyframe"


def of_context(has: Callable[[Context], object], otherwise: str) -> Requirement:
    """Something that must be so whatever the take."""
    return lambda context, _: None if has(context) else otherwise


def _mode(context: Context) -> str:
    """The mode of the active object; Blender adds objects in Object Mode alone."""
    active = context.view_layer.objects.active
    return "OBJECT" if active is None else active.mode


registered_library = of_context(
    lambda context: len(context.window_manager.keymark_shelf.libraries), "Load a keyframe library first"
)
OBJECT_MODE = "Choose Object Mode first, at the top left of the view"
object_mode_possible = of_context(lambda context: _mode(context) == "OBJECT", OBJECT_MODE)
bones_editable = of_context(lambda context: _mode(context) in ("OBJECT", "POSE"), OBJECT_MODE)
idle = of_context(
    lambda context: not job_is_running(context),
    "Another of Keymark's jobs is running; wait for it, or stop it with Esc",
)
RECONSTRUCTION = (footage, actor, anything_to_follow, all_colors, two_keyframes, idle)
