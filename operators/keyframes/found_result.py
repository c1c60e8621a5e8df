"""Keyframes found in a take's footage: their candidates stored, their postures keyed on the actor."""

from collections.abc import Sequence
from math import pi

import numpy as np
from bpy.types import PropertyGroup, Scene
from numpy.typing import ArrayLike

from ...core.arrays import Array
from ...core.body.actor import Actor
from ...core.body.human import HUMAN, TRUNK, limb_of
from ...core.body.kinematics import Body
from ...core.body.posture import Posture, headings_rad, yaw_rotation
from ...core.markers.reading import Reading
from ...core.poses.found_poses import FoundPoses
from ...core.prior.keyframes import Keyframe
from ...core.session.session import Placed, Posed
from ..bridge.actions import assign_action
from ..bridge.footage_camera import set_still_pose
from ..bridge.keyframes import candidate_posture, remove_keyframes, take_over, write_matched
from ..shell.base_operator import capitalized
from ..shell.keyed_frames import has_frame, new_keyframe_action, straighten_unposed
from ..shell.notes import note_contradictions
from ..shell.results import keep_reading
from ..shell.take_state import TakeState
from ..shell.takes import actor_of, take_by_identifier
from .found_properties import PLACE_VALUES, known_matches
from .scene_session import SceneSession

ANYBODY = Body(Actor.from_stature(1.7))  # The body on which candidates are compared; its size hardly matters
ELSEWHERE_M = 0.15
"""Distance between joints of two candidates above which anybody sees that a limb is elsewhere [m]."""


def add_match(take: PropertyGroup, frame: float, library: str) -> PropertyGroup:
    """Add a found keyframe without candidates, in order of frame; others may move in memory."""
    matches = take.matching.matches
    place = sum(match.frame < frame for match in matches)
    match = matches.add()
    match.frame, match.library = frame, library
    matches.move(len(matches) - 1, place)
    return matches[place]


def add_candidate(match: PropertyGroup, posture: Posture, name: str, mirror: bool, confidence: float) -> None:
    """Add a posture that a found keyframe's frame may show; the first one added is the one it has."""
    candidate = match.candidates.add()
    candidate.name, candidate.mirrored, candidate.confidence = name, mirror, confidence
    vector = posture.to_vector()
    candidate.place, candidate.turns = vector[:PLACE_VALUES], vector[PLACE_VALUES:]
    first = candidate_posture(match.candidates[0])
    own, other = headings_rad(Posture.stack([posture, first])).tolist()
    candidate.turned = (own - other + pi) % (2.0 * pi) - pi
    # Limbs whose joints are elsewhere on the body than those of the first, which may face another way.
    here, there = (ANYBODY.points(ANYBODY.pose(each)) - each.translation for each in (posture, first))
    distance = np.linalg.norm(here @ yaw_rotation(other - own).T - there, axis=-1)
    away = zip(HUMAN.point_names, distance > ELSEWHERE_M, strict=True)
    candidate.limbs = " ".join(sorted({limb_of(name) for name, far in away if far} - {TRUNK}))


def key_matches(take: PropertyGroup, frames: ArrayLike, postures: Sequence[Posture]) -> None:
    """Key postures at scene frames (K,) as found ones, and assign the keyframes to the actor."""
    actor = actor_of(take)
    take.keyframe_action = take.keyframe_action or new_keyframe_action(actor)
    write_matched(actor, take.keyframe_action, np.asarray(frames), postures)
    straighten_unposed(take)
    assign_action(actor, take.keyframe_action)


def write_poses(scene: Scene, made: SceneSession) -> PropertyGroup:
    """Key what was found beside what is decided, and move the camera as the floor did; returns the take."""
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
    sought = [key for key in posed.seen.take.keyframes if key.matched is not None]
    free = [key for key in sought if not has_frame(sorted(decided), float(frames[key.index]))]
    write_found(take, frames, free, found)
    before, camera = made.session[Placed].seen.take.camera, posed.seen.take.camera
    if not np.array_equal(before.matrix_world, camera.matrix_world):
        set_still_pose(take.camera, camera)
    return take


def clear_found(take: PropertyGroup) -> int:
    """Remove the found keyframes that nobody changed or chose; what was stays. Returns how many had keys."""
    actor, matching = actor_of(take), take.matching
    undecided = tuple(known_matches(take, by_hand=False))
    if take.keyframe_action is not None:
        take_over(actor, take.keyframe_action, TakeState(take).posed)
        remove_keyframes(actor, take.keyframe_action, undecided)
    kept = [match.by_hand and TakeState(take).of_match(match) == "FOUND" for match in matching.matches]
    for index in reversed(range(len(kept))):
        if not kept[index]:
            note_contradictions(take, matching.matches[index].frame, ())
            matching.matches.remove(index)
    for name in ("reason", "fit", "floor_found", "active_match"):
        matching.property_unset(name)
    return len(undecided)


def write_found(
    take: PropertyGroup, clip_frames: Array, keyframes: Sequence[Keyframe], found: FoundPoses
) -> None:
    """Key found postures of a clip's scene frames (F,), and store what is known of them as new entries."""
    candidates = {frame.index: frame.candidates for frame in found.frames}
    for keyframe in keyframes:
        matched, frame = keyframe.matched, float(clip_frames[keyframe.index])
        assert matched is not None
        match = add_match(take, frame, matched.library)
        add_candidate(match, keyframe.posture, matched.posture, matched.mirrored, matched.confidence)
        more = candidates.get(keyframe.index, ())[1:]
        for other in sorted(more, key=lambda other: -other.confidence):
            add_candidate(match, other.posture, other.name, other.mirrored, other.confidence)
        note_contradictions(take, frame, found.contradictions.get(keyframe.index, ()))
    if keyframes:
        frames = clip_frames[[keyframe.index for keyframe in keyframes]]
        key_matches(take, frames, [keyframe.posture for keyframe in keyframes])
