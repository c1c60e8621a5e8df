"""A scene's clip, read for finding postures in it, with what the animator has decided on."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy

from ...core.arrays import Array
from ...core.progress import stretch
from ..follow.evidence import scene_evidence
from ..shell.results import reading_of
from ..shell.takes import footage_of
from .found_keyframes import undecided_matches

if TYPE_CHECKING:
    from ...core.footage.reading import Reading
    from ...core.progress import Job
    from ...core.take.take import Take


TIMES = 0.1  # Share of the work at which the clip's times are read


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
    """The scene's take with all keyframes, and notes; found ones that nobody decided on are marked so.

    Raises:
        InputError: Something is missing or unusable.
    """
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
    """Read the scene's take and its clip; a clip that was read before is not decoded again.

    Raises:
        InputError: Something is missing or unusable.
    """
    from ...core.take.read_footage import read_footage
    from ..bridge.scene_frames import scene_frames

    kept = reading_of(settings)
    whole, notes = yield from stretch(read_known_take(scene, settings), 0.0, TIMES)
    take = replace(whole, keyframes=tuple(each for each in whole.keyframes if each.matched is None))
    reading = yield from stretch(read_footage(take, kept), TIMES, 1.0)
    frames = scene_frames(reading.tracks.time_s, take.frame_start, take.fps)
    return SceneClip(take, reading, frames, notes)
