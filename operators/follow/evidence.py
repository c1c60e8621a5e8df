"""What a take follows in its footage, as far as it is switched on, and what its keypoints show in a frame."""

from dataclasses import dataclass
from pathlib import Path
from time import monotonic

import bpy
import numpy as np
from bpy.types import PropertyGroup

from ...core.arrays import Array
from ...core.detect.keypoints import People
from ...core.errors import InputError
from ...core.files.paths import real_path
from ..bridge.footage_camera import may_move
from ..bridge.scene_evidence import (
    CLICKS,
    TRACKS,
    ClickedPoint,
    SceneEvidence,
    file_state,
    read_keypoint_file,
    tracks_at,
)
from ..shell.footage_view import clip_index
from ..shell.results import LruCache
from ..shell.takes import assigned_tracks, footage_of
from .marker_search import marker_styles
from .properties import ignored_regions


def scene_evidence(take: PropertyGroup) -> SceneEvidence:
    """What a take follows; refused where two markers have one name or one segment."""
    follow = take.follow
    files = [entry for entry in follow.files if entry.is_used and follow.use_keypoints]
    return SceneEvidence(
        markers=marker_styles(take) if follow.use_markers else (),
        files=tuple(keypoint_path(entry) for entry in files),
        tracks=assigned_tracks(take) if follow.use_tracks else (),
        clicks=clicked_points(take) if follow.use_keypoints else (),
        depth_hints=bool(follow.use_depth_hints),
        contours=bool(follow.use_contours),
        ignored_regions=ignored_regions(take) if follow.use_markers else (),
        reference=Path(bpy.path.abspath(follow.reference)) if follow.reference else None,
    )


def clicked_points(take: PropertyGroup) -> tuple[ClickedPoint, ...]:
    """The points that were clicked on."""
    return tuple(ClickedPoint(click.point, click.frame, tuple(click.pixel)) for click in take.follow.clicks)


def clip_frame(take: PropertyGroup) -> int:
    """The scene's current frame, counted from the clip's first."""
    scene = take.id_data
    return int(scene.frame_current - footage_of(scene, take).first_frame)


def clicked_here(take: PropertyGroup) -> list[str]:
    """The points that were clicked on in the current frame."""
    return [click.point for click in take.follow.clicks if click.frame == clip_frame(take)]


_states: dict[Path, tuple[float, str | None]] = {}
"""Time at which a path was looked at [s], and the state it had."""


def recent_state(path: Path) -> str | None:
    """A file's state as of a moment ago (see `file_state`); None where it is missing."""
    now = monotonic()
    if path not in _states or now - _states[path][0] >= 2.0:  # drawing reads no folder each time
        _states[path] = now, file_state(path)
    return _states[path][1]


def keypoint_path(entry: PropertyGroup) -> Path:
    """The path of a file of keypoints: from the root where the relative one is not of that file."""
    relative, absolute = Path(bpy.path.abspath(entry.filepath)), Path(entry.absolute_path)
    if not entry.absolute_path or relative == absolute:
        return relative
    state = recent_state(relative)
    if state is None or (state != entry.contents and recent_state(absolute) == entry.contents):
        return absolute if recent_state(absolute) is not None else relative
    return relative


def add_keypoint_file(take: PropertyGroup, path: Path, replace: bool = False) -> None:
    """Add a file of keypoints to a take, once, or in the chosen one's place; it is switched on and chosen."""
    from ..bridge.result_files import stored_path

    follow = take.follow
    known = [keypoint_path(entry) for entry in follow.files]
    if path in known:
        follow.active_file = known.index(path)
    elif not (replace and follow.active_file < len(known)):
        follow.files.add()
        follow.active_file = len(known)
    entry = follow.files[follow.active_file]
    entry.is_used = True
    entry.filepath, entry.absolute_path = stored_path(path), str(real_path(path))
    entry.contents = file_state(path) or ""


@dataclass(frozen=True, eq=False)
class KeypointReading:
    """A file of keypoints as it is on disk."""

    people: People | None  # Everyone in it, frame by frame of the file; None where it cannot be read
    problem: str = ""  # Why it cannot be read, for people
    is_missing: bool = False
    has_changed: bool = False  # Whether it has been written since it was loaded


_readings: LruCache[KeypointReading] = LruCache(12)


def keypoint_reading(take: PropertyGroup, entry: PropertyGroup) -> KeypointReading:
    """What a file of a take's keypoints says, or why it says nothing, so that drawing tries only once."""
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
    _states.clear()


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
    """What each source of a take that is on sees in a scene frame, always the same sources, readable ones."""
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


def _one_person(
    source: str, seen: list[tuple[str, tuple[float, float], float]], is_tracked: bool = False
) -> FrameKeypoints:
    pixel = np.array([place for _, place, _ in seen], dtype=np.float64).reshape(1, len(seen), 2)
    score = np.array([value for _, _, value in seen], dtype=np.float64).reshape(1, len(seen))
    return FrameKeypoints(source, tuple(point for point, _, _ in seen), pixel, score, is_tracked)


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
    seen = tracks_at(footage_of(take.id_data, take), take.id_data.frame_current, assigned)
    return f"{len(seen)} of {len(assigned)}"


def contours_label(take: PropertyGroup) -> str:
    """Whether contours can be followed."""
    if not take.follow.use_contours:
        return "Off"
    if take.camera is None:
        return ""
    return "Camera moves" if may_move(take.camera) else "Camera stands still"
