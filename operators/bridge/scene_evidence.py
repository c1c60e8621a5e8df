"""What a scene's take is held against: markers, and keypoints of files, motion tracks and clicks."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from operator import itemgetter
from pathlib import Path
from stat import S_ISDIR

import numpy as np
from bpy.types import MovieClip, MovieTrackingMarker, MovieTrackingTrack

from ...core.arrays import Array
from ...core.detect.keypoints import People, SeenPeople
from ...core.errors import InputError
from ...core.files.digest import digest
from ...core.markers.ignored_regions import IgnoredRegion
from ...core.markers.region_tracks import MarkerStyle
from .footage import Footage
from .scene_frames import shown_index


def read_keypoint_file(
    path: Path, frame_count: int | None, size: tuple[int, int], fps: float, frame_start: int
) -> People:
    """Everyone seen, by keypoints of a clip of this size [px], of as many frames if known; or InputError."""
    if (state := file_state(path)) is not None:
        return _read(path, state, frame_count, size, fps, frame_start)
    raise InputError(f"{path}: the keypoints are not there; load them from where they are now")


def file_state(path: Path) -> str | None:
    """A digest that changes when a file, or any file of a folder, is written; None where it is missing."""
    try:
        found = os.stat(path)
        if not S_ISDIR(found.st_mode):
            return digest(found.st_size, found.st_mtime_ns)
        with os.scandir(path) as entries:
            states = sorted(((entry.name, entry.stat()) for entry in entries), key=itemgetter(0))
    except (OSError, ValueError):
        return None
    return digest(tuple((name, state.st_size, state.st_mtime_ns) for name, state in states))


@lru_cache(maxsize=12)
def _read(
    path: Path, state: str, frame_count: int | None, size: tuple[int, int], fps: float, frame_start: int
) -> People:
    from ...core.detect.keypoint_file import read_keypoints

    return read_keypoints(path, frame_count, size, fps, frame_start)


def one_person(
    names: Sequence[str], source: str, size: tuple[int, int], pixel: Array, score: Array
) -> People:
    """The performer alone: N points in pixels (F, N, 2), NaN where not seen, and scores (F, N), 0 to 1."""
    unknown = np.full((1, len(names), 3), np.nan)
    nobody = SeenPeople(pixel[:0], score[:0], unknown[:0])
    there = np.isfinite(pixel).all(axis=-1).any(axis=-1)
    frames = tuple(
        SeenPeople(pixel[[index]], score[[index]], unknown) if there[index] else nobody
        for index in range(len(pixel))
    )
    return People(tuple(names), source, size, frames, by_hand=True)


CLICKS = "clicks"


@dataclass(frozen=True)
class ClickedPoint:
    """A body point that was clicked on in a frame."""

    point: str
    frame: int  # scene frames after the clip's first one: a clip may be moved in time
    pixel: tuple[float, float]


def people_of_clicks(footage: Footage, frames: Array, clicks: Sequence[ClickedPoint]) -> tuple[People, ...]:
    """The performer as clicked on in frames (F,), each last click; no source where nobody clicked."""
    at = shown_index(frames, [footage.first_frame + click.frame for click in clicks])
    inside = [(int(index), click) for index, click in zip(at, clicks, strict=True) if index >= 0]
    names = list(dict.fromkeys(click.point for _, click in inside))
    if not names:
        return ()
    pixel = np.full((len(frames), len(names), 2), np.nan)
    for index, click in inside:
        pixel[index, names.index(click.point)] = click.pixel
    score = np.isfinite(pixel).all(axis=-1).astype(np.float64)
    return (one_person(names, CLICKS, tuple(footage.clip.size), pixel, score),)


TRACKS = "tracks"


@dataclass(frozen=True)
class AssignedTrack:
    """A motion track, and the body point that it follows."""

    owner: str  # name of the clip's tracking object that it belongs to; the clip's first is its camera
    track: str
    point: str


def clip_tracks(clip: MovieClip) -> Iterator[tuple[str, MovieTrackingTrack]]:
    """Every track of a clip, those of its tracking objects included, with the object's name."""
    return ((each.name, track) for each in clip.tracking.objects for track in each.tracks)


def people_of_tracks(footage: Footage, frames: Array, tracks: Sequence[AssignedTrack]) -> tuple[People, ...]:
    """The performer as tracks of a clip show them at markers of their own; more of a point, more sources."""
    sources: list[dict[str, MovieTrackingTrack]] = []
    for point, track in _assigned(footage, tracks):
        source = next((points for points in sources if point not in points), None)
        if source is None:
            sources.append(source := {})
        source[point] = track
    people = []
    for rank, points in enumerate(sources):
        pixel = np.full((len(frames), len(points), 2), np.nan)
        score = np.zeros((len(frames), len(points)))
        for column, track in enumerate(points.values()):
            markers = [marker for marker in track.markers if not marker.mute] if track.weight > 0.0 else []
            index = shown_index(frames, [footage.clip.frame_start - 1 + marker.frame for marker in markers])
            pixel[index[index >= 0], column] = _places(footage, track, markers)[index >= 0]
            score[index, column] = float(track.weight)
        name = f"{TRACKS} {rank + 1}" if rank else TRACKS
        people.append(one_person(tuple(points), name, tuple(footage.clip.size), pixel, score))
    return tuple(people)


def tracks_at(
    footage: Footage, scene_frame: int, assigned: Sequence[AssignedTrack]
) -> list[tuple[str, tuple[float, float], float]]:
    """Point, place [px] and score of each assigned track that is seen in a scene frame, for display."""
    found = []
    for point, track in _assigned(footage, assigned):
        marker = track.markers.find_frame(scene_frame - footage.clip.frame_start + 1, exact=True)
        if marker is not None and not marker.mute and track.weight > 0.0:
            ((x, y),) = _places(footage, track, [marker]).tolist()
            found.append((point, (x, y), float(track.weight)))
    return found


def _assigned(
    footage: Footage, assigned: Sequence[AssignedTrack]
) -> Iterator[tuple[str, MovieTrackingTrack]]:
    tracks = {(owner, track.name): track for owner, track in clip_tracks(footage.clip)}
    keys = [(each.point, (each.owner, each.track)) for each in assigned]
    return ((point, tracks[key]) for point, key in keys if key in tracks)


def _places(footage: Footage, track: MovieTrackingTrack, markers: Sequence[MovieTrackingMarker]) -> Array:
    """Places (K, 2) of a track at its markers [px]; Blender counts in shares from the bottom left corner."""
    share = np.array([tuple(marker.co) for marker in markers], dtype=np.float64).reshape(-1, 2)
    width, height = footage.clip.size
    return np.asarray((share + tuple(track.offset)) * (width, -height) + (0.0, height))


@dataclass(frozen=True)
class SceneEvidence:
    """Evidence beside the keyframes, as far as it is switched on."""

    markers: tuple[MarkerStyle, ...] = ()
    files: tuple[Path, ...] = ()  # files of keypoints, or folders of them
    tracks: tuple[AssignedTrack, ...] = ()
    clicks: tuple[ClickedPoint, ...] = ()
    depth_hints: bool = True  # whether a detector's guess of depths is used
    contours: bool = True
    ignored_regions: tuple[IgnoredRegion, ...] = ()  # regions of the picture that are never a marker
    reference: Path | None = None  # file of a motion from elsewhere

    @property
    def has_keypoints(self) -> bool:
        return bool(self.files or self.tracks or self.clicks)

    def people(self, footage: Footage, frames: Array) -> tuple[People, ...]:
        """Everyone whom each source of keypoints saw, clicked points first; `frames` (F,) are the scene's."""
        width, height = footage.clip.size
        clip = len(frames), (width, height), footage.rate, footage.first_frame
        files = [read_keypoint_file(path, *clip) for path in self.files]
        files = files if self.depth_hints else [people.without_hints() for people in files]
        clicks = people_of_clicks(footage, frames, self.clicks)
        return (*clicks, *people_of_tracks(footage, frames, self.tracks), *files)
