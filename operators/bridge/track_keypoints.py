"""Blender's own motion tracks of a clip as keypoints: what a person has tracked is evidence, solved or not.

A track's markers stand at frames of the clip, counted from 1 at the clip's first frame on the timeline. Their
places are those in the picture as it is, with the lens's distortion, as core's camera projects them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from ...core.arrays import Array, IndexArray
from ...core.footage.keypoints.people import People
from .footage import Footage
from .one_person import one_person
from .scene_frames import shown_index

SOURCE = "tracks"
FIRST_CLIP_FRAME = 1
"""Frame of a track's marker in the first picture that the timeline shows."""


@dataclass(frozen=True)
class AssignedTrack:
    """A motion track, and the body point that it follows."""

    owner: str
    """Name of the clip's tracking object that it belongs to; the clip's first is its camera."""
    track: str
    point: str


def clip_tracks(clip: bpy.types.MovieClip) -> Iterator[tuple[str, bpy.types.MovieTrackingTrack]]:
    """Yield every track of a clip, those of its tracking objects included, with the object's name."""
    for tracking_object in clip.tracking.objects:
        for track in tracking_object.tracks:
            yield tracking_object.name, track


def people_of_tracks(
    footage: Footage, frames: Array, assigned: Sequence[AssignedTrack]
) -> tuple[People, ...]:
    """The performer as tracks of a clip show them; further tracks of the same point are further sources.

    A track is seen in the frames that have a marker of its own, tracked or set by hand, that is not disabled.
    What Blender shows before, between and after them is no observation.

    Args:
        footage: The clip in its scene.
        frames: (F,) scene frame of each frame of the clip.
        assigned: Tracks and their points; those that the clip does not have are left out.
    """
    tracks = {(owner, track.name): track for owner, track in clip_tracks(footage.clip)}
    sources: list[dict[str, bpy.types.MovieTrackingTrack]] = []
    for each in assigned:
        track = tracks.get((each.owner, each.track))
        if track is None:
            continue
        source = next((points for points in sources if each.point not in points), None)
        if source is None:
            sources.append(source := {})
        source[each.point] = track
    return tuple(_people(footage, frames, points, rank) for rank, points in enumerate(sources))


def tracks_at(
    footage: Footage, scene_frame: int, assigned: Sequence[AssignedTrack]
) -> list[tuple[str, tuple[float, float], float]]:
    """Point, place [px] and score of each assigned track that is seen in a scene frame, for display."""
    tracks = {(owner, track.name): track for owner, track in clip_tracks(footage.clip)}
    found = []
    for each in assigned:
        track = tracks.get((each.owner, each.track))
        marker = track and track.markers.find_frame(scene_frame - _start(footage), exact=True)
        if track is None or marker is None or marker.mute or track.weight <= 0.0:
            continue
        (place,) = _places(footage, track, [marker])
        found.append((each.point, (float(place[0]), float(place[1])), float(track.weight)))
    return found


def _people(
    footage: Footage, frames: Array, points: dict[str, bpy.types.MovieTrackingTrack], rank: int
) -> People:
    pixel = np.full((len(frames), len(points), 2), np.nan)
    score = np.zeros((len(frames), len(points)))
    for column, track in enumerate(points.values()):
        index, places = _seen(footage, frames, track)
        pixel[index, column] = places
        score[index, column] = float(track.weight)
    width, height = footage.clip.size
    source = f"{SOURCE} {rank + 1}" if rank else SOURCE
    return one_person(tuple(points), source, (width, height), pixel, score)


def _seen(footage: Footage, frames: Array, track: bpy.types.MovieTrackingTrack) -> tuple[IndexArray, Array]:
    """Indices (K,) of the clip's frames in which a track is seen, and its places there (K, 2) [px]."""
    markers = [marker for marker in track.markers if not marker.mute] if track.weight > 0.0 else []
    index = shown_index(frames, [_start(footage) + marker.frame for marker in markers])
    return index[index >= 0], _places(footage, track, markers)[index >= 0]


def _places(
    footage: Footage, track: bpy.types.MovieTrackingTrack, markers: Sequence[bpy.types.MovieTrackingMarker]
) -> Array:
    """Places (K, 2) of a track at its markers [px]; Blender counts in shares from the bottom left corner."""
    share = np.array([tuple(marker.co) for marker in markers], dtype=np.float64).reshape(-1, 2)
    width, height = footage.clip.size
    return np.asarray((share + tuple(track.offset)) * (width, -height) + (0.0, height))


def _start(footage: Footage) -> int:
    """Scene frame of a track's marker at frame 0."""
    return int(footage.clip.frame_start) - FIRST_CLIP_FRAME
