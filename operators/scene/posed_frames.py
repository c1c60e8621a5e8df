"""Which frames the animator has posed, known without looking at the keys at every redraw."""

from bisect import bisect_left

import bpy
from bpy.app.handlers import persistent

SAME_FRAME = 0.5
"""A key nearer than this [frames] is the frame's own."""
_posed: dict[tuple[int, int], tuple[float, ...]] = {}
"""By an armature and an Action, as Blender numbers them in a session: the frames keyed there."""


def posed_frames(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """Scene frames that are keyed in the take's keyframe Action, in order, wherever they were moved."""
    if take.armature is None or take.keyframe_action is None:
        return ()
    both = take.armature.session_uid, take.keyframe_action.session_uid
    if both not in _posed:
        from ...core.body.human import HUMAN
        from ...core.errors import InputError
        from ..bridge.keyframes import keyed_frames

        try:
            _posed[both] = keyed_frames(take.armature, take.keyframe_action, HUMAN)
        except InputError:  # an armature of other bones
            _posed[both] = ()
    return _posed[both]


def is_posed(take: bpy.types.PropertyGroup, frame: float) -> bool:
    """Whether a frame of the clip, which may lie between whole ones, has a key."""
    posed = posed_frames(take)
    after = bisect_left(posed, frame)
    return any(abs(near - frame) < SAME_FRAME for near in posed[max(0, after - 1) : after + 1])


def proposed_frames(take: bpy.types.PropertyGroup | None) -> list[int]:
    """The take's proposed scene frames, in order."""
    return sorted({proposal.frame for proposal in take.proposals}) if take else []


def unposed(take: bpy.types.PropertyGroup | None) -> list[int]:
    """The proposed frames that have no key yet, in order."""
    if take is None:
        return []
    posed = {round(frame) for frame in posed_frames(take)}
    return [frame for frame in proposed_frames(take) if frame not in posed]


def forget() -> None:
    """Look at the keys again next time."""
    _posed.clear()


@persistent
def _changed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    if depsgraph is None or depsgraph.id_type_updated("ACTION"):
        forget()


@persistent
def _loaded(*_arguments: object) -> None:
    forget()


_ON_CHANGE = ("depsgraph_update_post",)
_ON_LOAD = ("load_post", "undo_post", "redo_post")


def register() -> None:
    """Forget whenever keys may have changed."""
    for name in _ON_CHANGE:
        getattr(bpy.app.handlers, name).append(_changed)
    for name in _ON_LOAD:
        getattr(bpy.app.handlers, name).append(_loaded)


def unregister() -> None:
    """Take the handlers away."""
    for name in _ON_CHANGE:
        getattr(bpy.app.handlers, name).remove(_changed)
    for name in _ON_LOAD:
        getattr(bpy.app.handlers, name).remove(_loaded)
    forget()
