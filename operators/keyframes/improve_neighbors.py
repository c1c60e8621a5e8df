"""Posing the found keyframes around a corrected one anew, with what the correction tells."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.errors import KeymarkError
from ...core.prior.texts import EVERY_LIBRARY
from ...core.progress import run
from ..follow.evidence import followed_markers
from ..follow.ignored_regions import ignored_regions
from ..shell.keyed_frames import match_at
from ..shell.results import reading_of
from ..shell.takes import footage_of
from .found_keyframes import SceneClip, read_known_take, undecided_matches

if TYPE_CHECKING:
    from ...core.footage.reading import Reading


def improve_neighbors(context: bpy.types.Context, take: bpy.types.PropertyGroup, frame: float) -> int:
    """Pose the found keyframes around one that was just stored, accepted or replaced; return their number.

    To be called within the same operator, so that one undo takes both back. Posed keyframes, and those whose
    candidate a person chose, never change; none does where *Improve Neighbors* is off, or the footage was not
    read as it is followed now.
    """
    if not take.matching.improve_neighbors or not undecided_matches(take):
        return 0
    # The correction holds even where nothing can be found around it.
    with suppress(KeymarkError), _waiting(context):
        reading = _reading(context.scene, take)
        return 0 if reading is None else _pose_anew(context.scene, take, reading, frame)
    return 0


def _reading(scene: bpy.types.Scene, take: bpy.types.PropertyGroup) -> "Reading | None":
    """The kept reading, if it is of this footage, these markers and these ignored regions."""
    from ...core.footage.reading import of_same_footage, reading_key

    reading = reading_of(take)
    if reading is None or take.clip_state.missing:
        return None
    footage = footage_of(scene, take)
    key = reading_key(footage.path, footage.rate, followed_markers(take), None, ignored_regions(take))
    return reading if of_same_footage(reading.key, key) else None


def _pose_anew(
    scene: bpy.types.Scene, settings: bpy.types.PropertyGroup, reading: "Reading", frame: float
) -> int:
    from ...core.posing.pose_clip import pose_clip
    from ...core.posing.turned import section_around, take_around
    from ..bridge.scene_frames import scene_frames
    from ..library.registry_files import named_libraries
    from .found_result import write_found

    known, notes = run(read_known_take(scene, settings))
    frames = scene_frames(reading.tracks.time_s, known.frame_start, known.fps)
    corrected = int(np.argmin(np.abs(frames - frame)))
    section = section_around(reading.tracks.time_s, corrected, known.keyframes)
    if not section.changed:
        return 0
    take = take_around(known, section)
    matching = settings.matching
    floor_m = float(matching.floor_found) if matching.is_property_set("floor_found") else None
    libraries = named_libraries(matching.library_name or EVERY_LIBRARY)
    between = section.first, section.last
    job = pose_clip(take, reading, libraries, floor_m, between=between, frames=section.changed)
    found = run(job)
    keyframes = [found.keyframe(each) for each in found.frames]
    for each in keyframes:
        matching.matches.remove(match_at(settings, float(frames[each.index])))
    write_found(settings, SceneClip(take, reading, frames, notes), keyframes, found)
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
    return len(keyframes)


@contextmanager
def _waiting(context: bpy.types.Context) -> Iterator[None]:
    """The mouse shows meanwhile that Blender is busy."""
    window = None if bpy.app.background else context.window
    if window is not None:
        window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        if window is not None:
            window.cursor_modal_restore()
