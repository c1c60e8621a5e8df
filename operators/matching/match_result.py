"""The result of finding keyframes in a take's footage, and how it is written into the scene."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import bpy

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.footage.reading import Reading
from ...core.matching.candidates import Candidate
from ...core.posing.found_poses import FoundPoses
from ...core.prior.keyframes import Keyframe
from ..bridge.matched_keyframes import remove_keyframes, take_over
from ..shell.keyed_frames import has_frame, invalidate_keyed_frames, matched_frames, posed_frames
from ..shell.results import keep_reading
from ..shell.takes import actor_of, take_by_identifier
from .match_edits import add_candidate, add_match, key_matches


@dataclass(frozen=True, eq=False)
class MatchResult:
    """The result of matching, for the scene."""

    take: str
    """The take's identifier."""
    frames: Array
    """(F,) scene frames."""
    reading: Reading
    found: FoundPoses
    keyframes: tuple[Keyframe, ...]
    """The matched keyframes."""
    notes: tuple[str, ...]

    def write(self, scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
        """Key the matches beside what is posed, in place of earlier matches; returns the take.

        Raises:
            InputError: The take or its actor has been removed, or the actor lacks bones.
        """
        take = take_by_identifier(scene, self.take)
        store_matches(take, self.found, self.keyframes, self.frames)
        keep_reading(take, self.reading)
        return take


def store_matches(
    take: bpy.types.PropertyGroup,
    found: FoundPoses,
    keyframes: Sequence[Keyframe],
    clip_frames: Array,
) -> None:
    """Key the matched postures on the actor and store what is known of them; earlier matches are replaced.

    What the animator has posed meanwhile, or changed of earlier matches, stays and is theirs for good.

    Args:
        take: The take.
        found: What was found.
        keyframes: The matched keyframes, in order of frame.
        clip_frames: (F,) scene frame of every frame of the clip.

    Raises:
        InputError: The take has no actor, or it lacks bones.
    """
    invalidate_keyed_frames()
    actor, earlier, posed = actor_of(take), matched_frames(take), posed_frames(take)
    if take.keyframe_action is not None:
        take_over(actor, take.keyframe_action, HUMAN, posed)
        remove_keyframes(actor, take.keyframe_action, HUMAN, earlier)
    matching = take.matching
    clear_found(matching)
    matching.reason = found.reason[:1].upper() + found.reason[1:]
    matching.fit, matching.floor_found = found.fit, found.floor_m
    known = {frame.index: frame.candidates for frame in found.frames}
    free = [each for each in keyframes if not has_frame(posed, float(clip_frames[each.index]))]
    _add_matches(take, free, known, clip_frames)
    invalidate_keyed_frames()


def _add_matches(
    take: bpy.types.PropertyGroup,
    keyframes: Sequence[Keyframe],
    known: Mapping[int, Sequence[Candidate]],
    clip_frames: Array,
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


def clear_found(matching: bpy.types.PropertyGroup) -> None:
    """Clear the results of matching; its settings stay."""
    matching.matches.clear()
    for name in ("reason", "fit", "floor_found", "active_match"):
        matching.property_unset(name)
