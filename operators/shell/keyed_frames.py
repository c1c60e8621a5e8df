"""A take's keyframes: the Action that animates the actor while it is posed, and what is posed or found."""

from bisect import bisect_left
from collections.abc import Sequence

import bpy
import numpy as np
from bpy.app.handlers import persistent
from bpy.types import Action, Depsgraph, Object, PropertyGroup
from numpy.typing import ArrayLike

from ...core.arrays import BoolArray
from ..bridge.actions import assign_action
from ..bridge.actor_bones import evaluated
from ..bridge.fcurves import straighten_extremities
from ..bridge.keys import keys_changed


def show_keyframes(take: PropertyGroup) -> bool:
    """Let the keyframe Action, evaluated at once, animate the actor; return whether another did."""
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


def straighten_unposed(take: PropertyGroup) -> None:
    """Put hands and feet back to rest that the motion has turned, before keyframes are stored or shown."""
    data = take.armature.animation_data
    shown = None if data is None else data.action
    if shown is not None and shown in (take.motion_action, take.finish.action):
        frame = float(bpy.context.scene.frame_current_final)
        straighten_extremities(take.armature, shown, take.keyframe_action, frame)


def new_keyframe_action(armature_object: Object) -> Action:
    """An empty Action for keyframes, with a fake user: kept while the motion's is in use."""
    action = bpy.data.actions.new(f"{armature_object.name} Keyframes")
    action.use_fake_user = True
    return action


SAME_FRAME = 0.5  # a key nearer to a frame than this [frames] counts as that frame's


def has_frame(frames: Sequence[float], frame: float) -> bool:
    """Whether ascending frames contain one within `SAME_FRAME`."""
    after = bisect_left(frames, frame)
    return any(abs(near - frame) < SAME_FRAME for near in frames[max(0, after - 1) : after + 1])


def have_frames(frames: Sequence[float], wanted: ArrayLike) -> BoolArray:
    """Which of the wanted frames (K,) ascending frames contain, as `has_frame` tells of one."""
    sought, known = np.asarray(wanted, dtype=np.float64), np.asarray(frames, dtype=np.float64)
    if not len(known):
        return np.zeros(len(sought), dtype=bool)
    after = np.searchsorted(known, sought)
    near = np.stack([known[np.maximum(after - 1, 0)], known[np.minimum(after, len(known) - 1)]])
    return np.asarray((np.abs(near - sought) < SAME_FRAME).any(axis=0))


@persistent
def _on_change(_scene: object = None, depsgraph: Depsgraph | None = None) -> None:
    if depsgraph is None or depsgraph.id_type_updated("ACTION"):
        keys_changed()


HANDLERS = dict.fromkeys(("depsgraph_update_post", "load_post", "undo_post", "redo_post"), _on_change)
"""They tell when keys may have changed."""
