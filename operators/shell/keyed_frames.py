"""Which frames are keyframes, posed or matched, known without looking at the keys at every redraw."""

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

import bpy
from bpy.app.handlers import persistent

from ...core.body.human import HUMAN
from ...core.errors import InputError

SAME_FRAME = 0.5
"""A key nearer than this [frames] is the frame's own."""


@dataclass(frozen=True)
class KeyedFrames:
    """Scene frames keyed in an Action, in order."""

    all: tuple[float, ...] = ()
    untouched: tuple[float, ...] = ()
    """Those of them whose keys are as matching wrote them."""


_keyed: dict[tuple[int, int], KeyedFrames] = {}
"""By an armature and an Action, as Blender numbers them in a session."""


def keyframes_of(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """Scene frames of all of the take's keyframes, posed or matched, in order, wherever they were moved."""
    return _keyed_of(take).all


def matched_frames(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """Scene frames that were matched with a library and not touched since, in order."""
    known = {round(match.frame, 3) for match in take.matching.matches}
    return tuple(frame for frame in _keyed_of(take).untouched if frame in known)


def posed_frames(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """Scene frames that the animator has posed, in order."""
    matched = set(matched_frames(take))
    return tuple(frame for frame in keyframes_of(take) if frame not in matched)


def _keyed_of(take: bpy.types.PropertyGroup) -> KeyedFrames:
    if take.armature is None or take.keyframe_action is None:
        return KeyedFrames()
    both = take.armature.session_uid, take.keyframe_action.session_uid
    if both not in _keyed:
        from ..bridge.keyframes import keyed_frames
        from ..bridge.matched_keyframes import untouched_frames

        given = take.armature, take.keyframe_action, HUMAN
        try:
            _keyed[both] = KeyedFrames(keyed_frames(*given), untouched_frames(*given))
        except InputError:  # an armature of other bones
            _keyed[both] = KeyedFrames()
    return _keyed[both]


def is_posed(take: bpy.types.PropertyGroup, frame: float) -> bool:
    """Whether the animator has posed a frame of the clip, which may lie between whole ones."""
    return has_frame(posed_frames(take), frame)


def has_frame(frames: Sequence[float], frame: float) -> bool:
    """Whether one of some frames, in order, is this one."""
    after = bisect_left(frames, frame)
    return any(abs(near - frame) < SAME_FRAME for near in frames[max(0, after - 1) : after + 1])


def proposed_frames(take: bpy.types.PropertyGroup | None) -> list[int]:
    """The take's proposed scene frames, in order."""
    return sorted({proposal.frame for proposal in take.proposals}) if take else []


def unposed(take: bpy.types.PropertyGroup | None) -> list[int]:
    """The proposed frames that have no keyframe yet, in order."""
    if take is None:
        return []
    keyed = {round(frame) for frame in keyframes_of(take)}
    return [frame for frame in proposed_frames(take) if frame not in keyed]


def invalidate_keyed_frames() -> None:
    """Look at the keys again next time."""
    _keyed.clear()


@persistent
def _changed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    if depsgraph is None or depsgraph.id_type_updated("ACTION"):
        invalidate_keyed_frames()


@persistent
def _loaded(*_arguments: object) -> None:
    invalidate_keyed_frames()


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
    invalidate_keyed_frames()
