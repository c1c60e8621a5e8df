"""Keyframes found in a take's footage, and how they are written into the scene."""

from collections.abc import Sequence

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.markers.reading import Reading
from ...core.poses.found_poses import FoundPoses
from ...core.prior.keyframes import Keyframe
from ...core.session.place import Placed
from ...core.session.pose import Posed
from ..bridge.footage_camera import set_still_pose
from ..bridge.keyframes import remove_keyframes, take_over
from ..shell.base_operator import capitalized
from ..shell.contradictions import note_contradictions
from ..shell.keyed_frames import has_frame
from ..shell.results import keep_reading
from ..shell.take_state import TakeState
from ..shell.takes import actor_of, take_by_identifier
from .found_keyframes import undecided_matches
from .match_edits import add_candidate, add_match, key_matches
from .scene_session import SceneSession


def write_poses(scene: bpy.types.Scene, made: SceneSession) -> bpy.types.PropertyGroup:
    """Key what was found beside what is decided, in place of what was found earlier; returns the take.

    Where the world was moved so that the floor is z = 0, the camera is.
    """
    take, posed = take_by_identifier(scene, made.take), made.session[Posed]
    assert posed.found is not None
    clear_found(take)
    matching, found, frames = take.matching, posed.found, made.frames
    matching.fit, matching.floor_found = found.fit, found.floor_m
    matching.reason = capitalized(found.reason)
    decided = (*TakeState(take).posed, *(match.frame for match in matching.matches))
    keep_reading(take, made.session[Reading])
    if made.session.inputs.frames is None:
        take.proposals.clear()
        for each in found.frames:
            take.proposals.add().frame = round(float(frames[each.index]))
    free = [
        key
        for key in posed.seen.take.keyframes
        if key.matched is not None and not has_frame(sorted(decided), float(frames[key.index]))
    ]
    write_found(take, frames, free, found)
    before, camera = made.session[Placed].seen.take.camera, posed.seen.take.camera
    if not np.array_equal(before.matrix_world, camera.matrix_world):
        set_still_pose(take.camera, camera)
    return take


def clear_found(take: bpy.types.PropertyGroup) -> int:
    """Remove the found keyframes that nobody has decided on; returns how many had keys.

    What the animator has posed meanwhile, or changed of them, stays and is theirs for good. What they chose
    the candidate of stays as it is.

    Raises:
        InputError: The take has no actor, or it lacks bones.
    """
    actor, matching = actor_of(take), take.matching
    undecided = tuple(undecided_matches(take))
    if take.keyframe_action is not None:
        take_over(actor, take.keyframe_action, HUMAN, TakeState(take).posed)
        remove_keyframes(actor, take.keyframe_action, HUMAN, undecided)
    kept = [match.by_hand and TakeState(take).of_match(match) == "FOUND" for match in matching.matches]
    for index in reversed(range(len(kept))):
        if not kept[index]:
            note_contradictions(take, matching.matches[index].frame, ())
            matching.matches.remove(index)
    for name in ("reason", "fit", "floor_found", "active_match"):
        matching.property_unset(name)
    return len(undecided)


def write_found(
    take: bpy.types.PropertyGroup, clip_frames: Array, keyframes: Sequence[Keyframe], found: FoundPoses
) -> None:
    """Key found postures, in order of frame, and store what is known of them; none may have an entry yet.

    `clip_frames` (F,) are the scene frames of the clip's.
    """
    candidates = {frame.index: frame.candidates for frame in found.frames}
    for keyframe in keyframes:
        said, frame = keyframe.matched, float(clip_frames[keyframe.index])
        assert said is not None
        match = add_match(take, frame, said.library)
        add_candidate(match, keyframe.posture, said.posture, said.mirrored, said.confidence)
        others = candidates.get(keyframe.index, ())[1:]
        for other in sorted(others, key=lambda other: -other.confidence):
            add_candidate(match, other.posture, other.name, other.mirrored, other.confidence)
        note_contradictions(take, frame, found.contradictions.get(keyframe.index, ()))
    if keyframes:
        frames = clip_frames[[keyframe.index for keyframe in keyframes]]
        key_matches(take, frames, [keyframe.posture for keyframe in keyframes])
