"""A take's keypoint files as panels and overlays show them, read when they are first needed.

A file that cannot be read is remembered with its sentence, so that drawing does not try again and again.
"""

from dataclasses import dataclass

import numpy as np
from bpy.types import PropertyGroup

from ...core.arrays import Array
from ...core.detect.keypoints import People
from ...core.errors import InputError
from ..bridge.footage_camera import may_move
from ..bridge.scene_evidence import CLICKS, TRACKS, read_keypoint_file, tracks_at
from ..shell.footage_view import clip_index
from ..shell.results import LruCache
from ..shell.takes import assigned_tracks, footage_of
from .evidence import clicked_here, clicked_points, forget_states, keypoint_path, recent_state


@dataclass(frozen=True, eq=False)
class KeypointReading:
    """A file of keypoints as it is on disk."""

    people: People | None  # Everyone in it, frame by frame of the file; None where it cannot be read
    problem: str = ""  # Why it cannot be read, for people
    is_missing: bool = False
    has_changed: bool = False  # Whether it has been written since it was loaded


_readings: LruCache[KeypointReading] = LruCache(12)


def keypoint_reading(take: PropertyGroup, entry: PropertyGroup) -> KeypointReading:
    """What a file of a take's keypoints says, or why it says nothing."""
    path = keypoint_path(entry)
    state = recent_state(path)
    footage = footage_of(take.id_data, take)
    size = (take.clip.size[0], take.clip.size[1]) if take.clip is not None else (0, 0)
    key = f"{path} {state} {size} {entry.contents}"

    def read() -> KeypointReading:
        try:
            people = read_keypoint_file(path, None, size, footage.rate, footage.first_frame)
        except InputError as error:
            sentence = str(error).replace(str(path), path.name)
            return KeypointReading(None, sentence, is_missing=state is None)
        return KeypointReading(people, has_changed=state != entry.contents)

    return _readings.known(key, read) or KeypointReading(None)


def clear_readings() -> None:
    """Look at every file anew."""
    _readings.clear()
    forget_states()


Seen = list[tuple[str, tuple[float, float], float]]
"""Body point, place [px] and score of each point of the performer."""


@dataclass(frozen=True, eq=False)
class FrameKeypoints:
    """What one source sees in a frame: H people with N body points each."""

    source: str  # Name of the detector; `clicks` and `tracks` for what a person clicked on or tracked
    names: tuple[str, ...]  # (N,) the body points; those of clicks and tracks are the ones seen here
    pixel: Array  # (H, N, 2) [px] of the footage as it is, NaN where a point is not seen
    score: Array  # (H, N) confidence, 0 to 1; 0 where not seen

    is_tracked: bool = False  # Whether they are motion tracks of the clip

    @property
    def seen_count(self) -> int:
        """How many points are seen of the person of whom most are."""
        return int(np.isfinite(self.pixel).all(axis=-1).sum(axis=-1).max(initial=0))


def keypoints_at(take: PropertyGroup, scene_frame: int) -> tuple[FrameKeypoints, ...]:
    """What each source of a take that is switched on sees in a scene frame, in every frame the same sources.

    Clicks and tracks are listed without any point where they have none; a file that cannot be read is left
    out, as the panel says.
    """
    follow = take.follow
    if take.clip is None or take.clip_state.missing or not all(take.clip.size):
        return ()
    found: list[FrameKeypoints] = []
    if follow.use_keypoints:
        if len(follow.clicks):
            found.append(clicks_at(take, scene_frame))
        index = clip_index(take, scene_frame)
        for entry in follow.files:
            people = keypoint_reading(take, entry).people if entry.is_used else None
            if people is not None:
                found.append(people_at(people, index))
    if follow.use_tracks:
        assigned = assigned_tracks(take)
        if assigned:
            tracked = tracks_at(footage_of(take.id_data, take), scene_frame, assigned)
            found.append(_one_person(TRACKS, tracked, is_tracked=True))
    return tuple(found)


def clicks_at(take: PropertyGroup, scene_frame: int) -> FrameKeypoints:
    """The points that were clicked on in a scene frame."""
    first = footage_of(take.id_data, take).first_frame
    here = [click for click in clicked_points(take) if first + click.frame == scene_frame]
    return _one_person(CLICKS, [(click.point, click.pixel, 1.0) for click in here])


def people_at(people: People, index: int) -> FrameKeypoints:
    """Everyone whom a source saw in a frame of the clip."""
    if not 0 <= index < len(people.frames):
        empty = np.zeros((0, len(people.names)))
        return FrameKeypoints(people.source, people.names, np.zeros((*empty.shape, 2)), empty)
    seen = people.frames[index]
    return FrameKeypoints(people.source, people.names, seen.pixel, seen.score)


def _one_person(source: str, seen: Seen, is_tracked: bool = False) -> FrameKeypoints:
    pixel = np.array([place for _, place, _ in seen], dtype=np.float64).reshape(1, len(seen), 2)
    score = np.array([value for _, _, value in seen], dtype=np.float64).reshape(1, len(seen))
    return FrameKeypoints(source, tuple(point for point, _, _ in seen), pixel, score, is_tracked)


# --- Labels of the panels


def keypoints_label(take: PropertyGroup) -> str:
    """How many points all files and clicks see in the current frame, as in `27 of 33`; empty without any."""
    if not take.follow.use_keypoints:
        return "Off"
    sources = [each for each in keypoints_at(take, take.id_data.frame_current) if not each.is_tracked]
    if not sources:
        return ""
    seen = sum(each.seen_count for each in sources)
    return f"{seen} of {sum(len(each.names) for each in sources)}"


def tracks_label(take: PropertyGroup) -> str:
    """How many of the assigned tracks are seen in the current frame: `4 of 6`; empty without any."""
    if not take.follow.use_tracks:
        return "Off"
    assigned = assigned_tracks(take)
    if not assigned:
        return ""
    scene = take.id_data
    seen = len(tracks_at(footage_of(scene, take), scene.frame_current, assigned))
    return f"{seen} of {len(assigned)}"


def contours_label(take: PropertyGroup) -> str:
    """Whether contours can be followed."""
    if not take.follow.use_contours:
        return "Off"
    if take.camera is None:
        return ""
    return "Camera moves" if may_move(take.camera) else "Camera stands still"


def clicked_label(take: PropertyGroup) -> str:
    """How many points were clicked on in the current frame, and in all."""
    return f"{len(clicked_here(take))} here, {len(take.follow.clicks)} in all"
