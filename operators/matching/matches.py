"""A take's matches: what is known of the keyframes that a library gave, kept with the take."""

from collections.abc import Mapping, Sequence
from math import pi
from typing import TYPE_CHECKING

import bpy

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.errors import InputError
from ..bridge.actions import assign_action
from ..shell.keyed_frames import forget, has_frame, matched_frames, posed_frames
from ..shell.keyframe_action import new_keyframe_action
from ..shell.takes import actor_of

if TYPE_CHECKING:
    from ...core.body.posture import Posture
    from ...core.matching.candidate import Candidate
    from ...core.matching.match_take import LibraryChoice
    from ...core.prior.keyframes import Keyframe, Matched


def known_matches(take: bpy.types.PropertyGroup) -> "dict[float, Matched]":
    """What the take's keyframes were matched with that nobody has touched since, by scene frame."""
    forget()  # a script may have changed a key that Blender has not told of yet
    untouched = set(matched_frames(take))
    matches = take.matching.matches
    return {round(match.frame, 3): match.matched for match in matches if round(match.frame, 3) in untouched}


def chosen_match(take: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup:
    """The match that is chosen in the list.

    Raises:
        InputError: There is none.
    """
    matching = take.matching
    if not 0 <= matching.active_match < len(matching.matches):
        raise InputError("no match is chosen; match a library first, and choose a frame in the list")
    return matching.matches[matching.active_match]


def state_of(take: bpy.types.PropertyGroup, match: bpy.types.PropertyGroup) -> str:
    """What has become of a match: MATCHED still, POSED by the animator, or GONE with its keys."""
    frame = round(match.frame, 3)
    if frame in matched_frames(take):
        return "MATCHED"
    return "POSED" if frame in posed_frames(take) else "GONE"


def add_match(take: bpy.types.PropertyGroup, frame: float, library: str) -> bpy.types.PropertyGroup:
    """Add a match without candidates."""
    match = take.matching.matches.add()
    match.frame, match.library = frame, library
    return match


def add_candidate(
    match: bpy.types.PropertyGroup, posture: "Posture", name: str, mirrored: bool, confidence: float
) -> None:
    """Add what a match's frame may show; the first one added is the one it has."""
    candidate = match.candidates.add()
    candidate.name, candidate.mirrored, candidate.confidence = name, mirrored, confidence
    candidate.take_posture(posture)
    apart = _heading(posture) - _heading(match.candidates[0].posture)
    candidate.turned = (apart + pi) % (2.0 * pi) - pi


def _heading(posture: "Posture") -> float:
    """Where the hips face, about the vertical [rad]."""
    import numpy as np

    from ...core.body.heading import facing_rad

    return facing_rad(posture.rotations[0] @ np.array([0.0, -1.0, 0.0]))


def clear_choice(matching: bpy.types.PropertyGroup) -> None:
    """Forget what was found; what is to be looked for stays."""
    for name in ("ranking", "matches"):
        getattr(matching, name).clear()
    for name in ("reason", "fit", "floor_found", "active_match"):
        matching.property_unset(name)


def keep_choice(
    take: bpy.types.PropertyGroup,
    choice: "LibraryChoice",
    keyframes: "Sequence[Keyframe]",
    clip_frames: "Array",
) -> None:
    """Key what matching found on the actor, and keep what is known of it, in place of what was found earlier.

    What the animator has posed meanwhile, or changed of earlier matches, stays and is theirs for good.

    Args:
        take: The take.
        choice: What was found.
        keyframes: The matched keyframes, in order of frame.
        clip_frames: (F,) scene frame of every frame of the clip.

    Raises:
        InputError: The take has no actor, or it lacks bones.
    """
    from ..bridge.matched_keyframes import remove_keyframes, take_over

    forget()
    actor, earlier, posed = actor_of(take), matched_frames(take), posed_frames(take)
    if take.keyframe_action is not None:
        take_over(actor, take.keyframe_action, HUMAN, posed)
        remove_keyframes(actor, take.keyframe_action, HUMAN, earlier)
    matching, found = take.matching, choice.match
    clear_choice(matching)
    matching.reason = choice.reason[:1].upper() + choice.reason[1:]
    for library, probability in choice.ranking:
        chance = matching.ranking.add()
        chance.name, chance.probability = library.title, probability
    if found is not None:
        matching.fit = found.fit
        if found.floor_m is not None:
            matching.floor_found = found.floor_m
        known = {frame.index: frame.candidates for frame in found.frames}
        free = [each for each in keyframes if not has_frame(posed, float(clip_frames[each.index]))]
        _keep_matches(take, free, known, clip_frames)
    forget()


def _keep_matches(
    take: bpy.types.PropertyGroup,
    keyframes: "Sequence[Keyframe]",
    known: "Mapping[int, Sequence[Candidate]]",
    clip_frames: "Array",
) -> None:
    for keyframe in keyframes:
        matched = keyframe.matched
        if matched is not None:
            match = add_match(take, float(clip_frames[keyframe.index]), matched.library)
            add_candidate(match, keyframe.posture, matched.posture, matched.mirrored, matched.confidence)
            others = known.get(keyframe.index, ())[1:]
            for other in sorted(others, key=lambda other: -other.confidence):
                add_candidate(match, other.posture, other.name, other.mirrored, other.confidence)
    if keyframes:
        frames = clip_frames[[keyframe.index for keyframe in keyframes]]
        key_matches(take, frames, [keyframe.posture for keyframe in keyframes])


def key_matches(take: bpy.types.PropertyGroup, frames: "Array", postures: "Sequence[Posture]") -> None:
    """Key postures at scene frames (K,) as matched ones, and let the keyframes animate the actor."""
    from ..bridge.matched_keyframes import write_matched

    actor = actor_of(take)
    take.keyframe_action = take.keyframe_action or new_keyframe_action(actor)
    write_matched(actor, take.keyframe_action, frames, postures)
    assign_action(actor, take.keyframe_action)
    forget()
