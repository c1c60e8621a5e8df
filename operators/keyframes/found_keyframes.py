"""A take's keyframes and its clip, as jobs read them from the scene, and which found ones are undecided."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.progress import stretch
from ..follow.evidence import scene_evidence
from ..shell.keyed_frames import invalidate_keyed_frames, matched_frames
from ..shell.results import reading_of
from ..shell.takes import footage_of

if TYPE_CHECKING:
    from ...core.markers.reading import Reading
    from ...core.prior.keyframes import Matched
    from ...core.progress import Job
    from ...core.take.take import Take


def known_matches(take: bpy.types.PropertyGroup) -> "dict[float, Matched]":
    """What the take's found keyframes were made of, by scene frame, those changed since left out."""
    return {round(match.frame, 3): match.matched for match in _untouched(take)}


def undecided_matches(take: bpy.types.PropertyGroup) -> "dict[float, Matched]":
    """The same without those whose candidate a person chose: what may be found anew, and removed."""
    return {round(match.frame, 3): match.matched for match in _untouched(take) if not match.by_hand}


def _untouched(take: bpy.types.PropertyGroup) -> list[bpy.types.PropertyGroup]:
    invalidate_keyed_frames()  # a script may have changed a key that Blender has not told of yet
    untouched = set(matched_frames(take))
    return [match for match in take.matching.matches if round(match.frame, 3) in untouched]


def chosen_match(take: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup:
    """The found keyframe that is chosen in the list: the current frame's, or else the last one chosen.

    Raises:
        InputError: There is none.
    """
    matching = take.matching
    if not 0 <= matching.shown_match < len(matching.matches):
        raise InputError("no found keyframe is chosen; pose all first, and choose a frame in the list")
    return matching.matches[matching.shown_match]


@dataclass(frozen=True, eq=False)
class SceneClip:
    """A scene's take with its clip read."""

    take: "Take"
    """With the keyframes that the animator posed or chose the candidate of; others are found anew."""
    reading: "Reading"
    frames: Array  # (F,) scene frames
    notes: tuple[str, ...]  # Sentences for the animator


def read_known_take(
    scene: bpy.types.Scene, settings: bpy.types.PropertyGroup
) -> "Job[tuple[Take, tuple[str, ...]]]":
    """The scene's take with all keyframes, and notes; found ones that nobody decided on are marked so."""
    from ..bridge.take_from_scene import read_scene_take

    return read_scene_take(
        footage_of(scene, settings),
        settings.armature,
        settings.keyframe_action,
        scene_evidence(settings),
        undecided_matches(settings),
        reading_of(settings),
    )


def read_scene_clip(scene: bpy.types.Scene, settings: bpy.types.PropertyGroup) -> "Job[SceneClip]":
    """Read the scene's take and its clip; a clip that was read before is not decoded again."""
    from ...core.take.read_footage import read_footage
    from ..bridge.scene_frames import scene_frames

    kept = reading_of(settings)
    whole, notes = yield from stretch(read_known_take(scene, settings), 0.0, 0.1)
    take = replace(whole, keyframes=tuple(each for each in whole.keyframes if each.matched is None))
    reading = yield from stretch(read_footage(take, kept), 0.1, 1.0)
    frames = scene_frames(reading.tracks.time_s, take.frame_start, take.fps)
    return SceneClip(take, reading, frames, notes)
