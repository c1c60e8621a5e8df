"""Keyframes found in a take's footage, and how they are written into the scene."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.posing.found_poses import FoundPoses, with_found
from ...core.prior.keyframes import Keyframe
from ...core.take.take import Take
from ..bridge.keyframes import remove_keyframes, take_over
from ..shell.base_operator import capitalized
from ..shell.contradictions import note_contradictions
from ..shell.keyed_frames import has_frame, invalidate_keyed_frames, posed_frames, state_of
from ..shell.results import keep_reading, keep_speed
from ..shell.takes import actor_of, take_by_identifier
from .found_keyframes import SceneClip, undecided_matches
from .match_edits import add_candidate, add_match, key_matches


@dataclass(frozen=True, eq=False)
class Proposals:
    """Frames proposed for keyframes, and what they were chosen by."""

    indices: tuple[int, ...]  # Of frames of the clip, in order
    speed: Array  # (F,) the performer's speed in the footage [px per frame]


@dataclass(frozen=True, eq=False)
class FoundResult:
    """What a job found in a take's footage, for the scene."""

    take: str  # The take's identifier
    clip: SceneClip
    found: FoundPoses
    keyframes: tuple[Keyframe, ...]  # The found keyframes, in order
    proposals: Proposals | None = None  # Where no frames were proposed before

    def write(self, scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
        """Key what was found beside what is decided, in place of what was found earlier; returns the take."""
        take = take_by_identifier(scene, self.take)
        clear_found(take)
        matching, found = take.matching, self.found
        matching.fit, matching.floor_found = found.fit, found.floor_m
        matching.reason = capitalized(found.reason)
        posed, frames = posed_frames(take), self.clip.frames
        decided = [match.frame for match in matching.matches]
        free = [
            keyframe
            for keyframe in self.keyframes
            if not has_frame(posed, float(frames[keyframe.index]))
            and not has_frame(decided, float(frames[keyframe.index]))
        ]
        keep_reading(take, self.clip.reading)
        if self.proposals is not None:
            keep_speed(take, frames, self.proposals.speed)
            take.proposals.clear()
            for index in self.proposals.indices:
                take.proposals.add().frame = round(float(frames[index]))
        write_found(take, self.clip, free, found)
        return take


def found_keyframes(take: Take, found: FoundPoses) -> tuple[Keyframe, ...]:
    """The found keyframes of a take with decided ones, in order."""
    return tuple(each for each in with_found(take, found).keyframes if each.matched is not None)


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
        take_over(actor, take.keyframe_action, HUMAN, posed_frames(take))
        remove_keyframes(actor, take.keyframe_action, HUMAN, undecided)
    kept = [match.by_hand and state_of(take, match) == "FOUND" for match in matching.matches]
    for index in reversed(range(len(kept))):
        if not kept[index]:
            note_contradictions(take, matching.matches[index].frame, ())
            matching.matches.remove(index)
    for name in ("reason", "fit", "floor_found", "active_match"):
        matching.property_unset(name)
    invalidate_keyed_frames()
    return len(undecided)


def write_found(
    take: bpy.types.PropertyGroup, clip: SceneClip, keyframes: Sequence[Keyframe], found: FoundPoses
) -> None:
    """Key found postures, in order of frame, and store what is known of them; none may have an entry yet."""
    candidates = {frame.index: frame.candidates for frame in found.frames}
    for keyframe in keyframes:
        said, frame = keyframe.matched, float(clip.frames[keyframe.index])
        assert said is not None
        match = add_match(take, frame, said.library)
        add_candidate(match, keyframe.posture, said.posture, said.mirrored, said.confidence)
        others = candidates.get(keyframe.index, ())[1:]
        for other in sorted(others, key=lambda other: -other.confidence):
            add_candidate(match, other.posture, other.name, other.mirrored, other.confidence)
        note_contradictions(take, frame, found.contradictions.get(keyframe.index, ()))
    if keyframes:
        frames = clip.frames[[keyframe.index for keyframe in keyframes]]
        key_matches(take, frames, [keyframe.posture for keyframe in keyframes])
    invalidate_keyed_frames()
