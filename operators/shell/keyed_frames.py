"""A take's keyframes: the Action that animates the actor while it is posed, and what is posed or found."""

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
from ..bridge.actions import assign_action
from ..bridge.keys import FOUND, PICTURED, keys_changed, revision
from ..bridge.object_space import evaluated
from .contradictions import contradictions_at


def shows_keyframes(take: bpy.types.PropertyGroup) -> bool:
    """Whether the actor is animated by its keyframe Action, or by none."""
    data = take.armature.animation_data
    return data is None or data.action is None or data.action == take.keyframe_action


def show_keyframes(take: bpy.types.PropertyGroup) -> bool:
    """Let the keyframe Action animate the actor instead of the motion; return whether that changed anything.

    The new Action is evaluated at once: evaluated later, it would overwrite a pose set in between.
    """
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


def straighten_unposed(take: bpy.types.PropertyGroup) -> None:
    """Put hands and feet back to rest where they stand as the motion that is shown has turned them.

    To be called before keyframes are stored or shown: nobody has posed these.
    """
    from ..bridge.extremity_curves import straighten_extremities

    data = take.armature.animation_data
    shown = None if data is None else data.action
    if shown is not None and shown in (take.motion_action, take.finish.action):
        frame = float(bpy.context.scene.frame_current_final)
        straighten_extremities(take.armature, HUMAN, shown, take.keyframe_action, frame)


def new_keyframe_action(armature_object: bpy.types.Object) -> bpy.types.Action:
    """An empty Action for keyframes, with a fake user: kept while the motion's is in use."""
    action = bpy.data.actions.new(f"{armature_object.name} Keyframes")
    action.use_fake_user = True
    return action


SAME_FRAME = 0.5  # a key nearer to a frame than this [frames] counts as that frame's


@dataclass(frozen=True)
class KeyedFrames:
    """Scene frames keyed in an Action, in ascending order."""

    all: tuple[float, ...] = ()
    untouched: tuple[float, ...] = ()  # those whose keys are unchanged since they were found
    pictured: tuple[float, ...] = ()  # those that a person put right in the picture alone


_keyed: dict[tuple[int, int, int], KeyedFrames] = {}
"""By the session numbers (`session_uid`) of an armature and an Action, and the revision of keys."""


def keyframes_of(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """The scene frames of a take's keyframes, posed and found, in ascending order."""
    return _keyed_of(take).all


def matched_frames(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """The scene frames that were found in the footage and not changed since, in ascending order."""
    known = {round(match.frame, 3) for match in take.matching.matches}
    return tuple(frame for frame in _keyed_of(take).untouched if frame in known)


def posed_frames(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """The scene frames that the animator posed, in ascending order."""
    matched = set(matched_frames(take))
    return tuple(frame for frame in keyframes_of(take) if frame not in matched)


def depth_is_found(take: bpy.types.PropertyGroup, frame: float) -> bool:
    """Whether a pose made from what a frame has is only as deep as it was found: nobody posed it in space.

    Where nothing is keyed that holds of every clip some of whose keyframes were found.
    """
    found = sorted({*matched_frames(take), *_keyed_of(take).pictured})
    return has_frame(found if has_frame(keyframes_of(take), frame) else found and [frame], frame)


def _keyed_of(take: bpy.types.PropertyGroup) -> KeyedFrames:
    if take.armature is None or take.keyframe_action is None:
        return KeyedFrames()
    key = take.armature.session_uid, take.keyframe_action.session_uid, revision()
    if key not in _keyed:
        from ..bridge.keyframes import keyed_frames, unchanged_keyframes

        for earlier in [each for each in _keyed if each[-1] != key[-1]]:
            del _keyed[earlier]
        source = take.armature, take.keyframe_action, HUMAN
        try:
            found, pictured = (unchanged_keyframes(*source, kind) for kind in (FOUND, PICTURED))
            _keyed[key] = KeyedFrames(keyed_frames(*source), found, pictured)
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
    """The take's proposed scene frames, in ascending order."""
    return sorted({proposal.frame for proposal in take.proposals}) if take else []


def unposed_proposals(take: bpy.types.PropertyGroup | None) -> list[int]:
    """The proposed frames without a keyframe, in ascending order."""
    if take is None:
        return []
    keyed = {round(frame) for frame in keyframes_of(take)}
    return [frame for frame in proposed_frames(take) if frame not in keyed]


@persistent
def _on_change(_scene: object = None, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    if depsgraph is None or depsgraph.id_type_updated("ACTION"):
        keys_changed()


HANDLERS = ("depsgraph_update_post", "load_post", "undo_post", "redo_post")


def register() -> None:
    """Add handlers that tell when keys may have changed."""
    for name in HANDLERS:
        getattr(bpy.app.handlers, name).append(_on_change)


def unregister() -> None:
    """Remove the handlers."""
    for name in HANDLERS:
        getattr(bpy.app.handlers, name).remove(_on_change)


# --- Found keyframes of a take, those that nobody posed


DOUBTFUL = 0.5  # confidence below which a found keyframe is doubtful: it is more likely wrong than right


def state_of(take: bpy.types.PropertyGroup, match: bpy.types.PropertyGroup) -> str:
    """What has become of a found keyframe: FOUND still, POSED by the animator, or GONE with its keys."""
    frame = round(match.frame, 3)
    if frame in matched_frames(take):
        return "FOUND"
    return "POSED" if frame in posed_frames(take) else "GONE"


def is_doubtful(take: bpy.types.PropertyGroup, match: bpy.types.PropertyGroup) -> bool:
    """Whether a found keyframe is worth a check: undecided yet, and unsure or contradicted."""
    if match.by_hand or state_of(take, match) != "FOUND":
        return False
    return bool(match.confidence < DOUBTFUL or contradictions_at(take, match.frame))


def doubtful_matches(take: bpy.types.PropertyGroup) -> list[int]:
    """Places in the list of the doubtful found keyframes: contradicted ones first, then the least sure."""
    matches: Sequence[bpy.types.PropertyGroup] = take.matching.matches

    def rank(index: int) -> tuple[bool, float, int]:
        match = matches[index]
        return not contradictions_at(take, match.frame), match.confidence, index

    return sorted((index for index, match in enumerate(matches) if is_doubtful(take, match)), key=rank)


def match_at(take: bpy.types.PropertyGroup, frame: float) -> int:
    """Place in the list of the found keyframe at a scene frame; -1 for none."""
    apart = [abs(match.frame - frame) for match in take.matching.matches]
    nearest = min(range(len(apart)), key=apart.__getitem__, default=-1)
    return nearest if apart and apart[nearest] < SAME_FRAME else -1


def offered_at(take: bpy.types.PropertyGroup, frame: float) -> bpy.types.PropertyGroup | None:
    """The poses to choose from at a scene frame that has no key; None where there are none."""
    offered = take.offered
    here = len(offered.candidates) > 1 and abs(offered.frame - frame) < SAME_FRAME
    keyed = round(frame, 3) in {*matched_frames(take), *posed_frames(take)}
    return offered if here and not keyed else None


def count_found(take: bpy.types.PropertyGroup) -> tuple[int, int]:
    """Number of the found keyframes that are still as they were found, and of the doubtful ones."""
    matches = take.matching.matches
    return sum(state_of(take, match) == "FOUND" for match in matches), len(doubtful_matches(take))
