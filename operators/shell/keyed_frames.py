"""Scene frames of keyframes, posed and found, cached so that redraws need not read the keys."""

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.app.handlers import persistent
from numpy.typing import ArrayLike

from ...core.arrays import BoolArray
from ...core.body.human import HUMAN
from ...core.errors import InputError

SAME_FRAME = 0.5
"""A key nearer to a frame than this [frames] counts as that frame's."""


@dataclass(frozen=True)
class KeyedFrames:
    """Scene frames keyed in an Action, in ascending order."""

    all: tuple[float, ...] = ()
    untouched: tuple[float, ...] = ()
    """Those whose keys are unchanged since they were found."""


_keyed: dict[tuple[int, int], KeyedFrames] = {}
"""By the session numbers (`session_uid`) of an armature and an Action."""


def keyframes_of(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """Return the scene frames of a take's keyframes, posed and found, in ascending order."""
    return _keyed_of(take).all


def matched_frames(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """Return the scene frames that were found in the footage and not changed since, in ascending order."""
    known = {round(match.frame, 3) for match in take.matching.matches}
    return tuple(frame for frame in _keyed_of(take).untouched if frame in known)


def posed_frames(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """Return the scene frames that the animator posed, in ascending order."""
    matched = set(matched_frames(take))
    return tuple(frame for frame in keyframes_of(take) if frame not in matched)


def _keyed_of(take: bpy.types.PropertyGroup) -> KeyedFrames:
    if take.armature is None or take.keyframe_action is None:
        return KeyedFrames()
    key = take.armature.session_uid, take.keyframe_action.session_uid
    if key not in _keyed:
        from ..bridge.keyframes import keyed_frames
        from ..bridge.matched_keyframes import untouched_frames

        source = take.armature, take.keyframe_action, HUMAN
        try:
            _keyed[key] = KeyedFrames(keyed_frames(*source), untouched_frames(*source))
        except InputError:  # an armature of other bones
            _keyed[key] = KeyedFrames()
    return _keyed[key]


def is_posed(take: bpy.types.PropertyGroup, frame: float) -> bool:
    """Whether the animator posed a frame; a clip's frame may lie between whole scene frames."""
    return has_frame(posed_frames(take), frame)


def has_frame(frames: Sequence[float], frame: float) -> bool:
    """Whether ascending frames contain one within `SAME_FRAME`."""
    after = bisect_left(frames, frame)
    return any(abs(near - frame) < SAME_FRAME for near in frames[max(0, after - 1) : after + 1])


def have_frames(frames: Sequence[float], wanted: ArrayLike) -> BoolArray:
    """Which of the wanted frames (K,) ascending frames contain, as `has_frame` tells of one."""
    asked, known = np.asarray(wanted, dtype=np.float64), np.asarray(frames, dtype=np.float64)
    if not len(known):
        return np.zeros(len(asked), dtype=bool)
    after = np.searchsorted(known, asked)
    near = np.stack([known[np.maximum(after - 1, 0)], known[np.minimum(after, len(known) - 1)]])
    return np.asarray((np.abs(near - asked) < SAME_FRAME).any(axis=0))


def proposed_frames(take: bpy.types.PropertyGroup | None) -> list[int]:
    """Return the take's proposed scene frames, in ascending order."""
    return sorted({proposal.frame for proposal in take.proposals}) if take else []


def unposed_proposals(take: bpy.types.PropertyGroup | None) -> list[int]:
    """Return the proposed frames without a keyframe, in ascending order."""
    if take is None:
        return []
    keyed = {round(frame) for frame in keyframes_of(take)}
    return [frame for frame in proposed_frames(take) if frame not in keyed]


def invalidate_keyed_frames() -> None:
    """Empty the cache: the next query reads the keys again."""
    _keyed.clear()


@persistent
def _on_change(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    if depsgraph is None or depsgraph.id_type_updated("ACTION"):
        invalidate_keyed_frames()


@persistent
def _on_load(*_arguments: object) -> None:
    invalidate_keyed_frames()


CHANGE_HANDLERS = ("depsgraph_update_post",)
LOAD_HANDLERS = ("load_post", "undo_post", "redo_post")


def register() -> None:
    """Add handlers that empty the cache when keys may have changed."""
    for name in CHANGE_HANDLERS:
        getattr(bpy.app.handlers, name).append(_on_change)
    for name in LOAD_HANDLERS:
        getattr(bpy.app.handlers, name).append(_on_load)


def unregister() -> None:
    """Remove the handlers."""
    for name in CHANGE_HANDLERS:
        getattr(bpy.app.handlers, name).remove(_on_change)
    for name in LOAD_HANDLERS:
        getattr(bpy.app.handlers, name).remove(_on_load)
    invalidate_keyed_frames()
