"""The keypoints that a take's sources see in one frame, with or without a motion: for panels and overlays."""

from dataclasses import dataclass

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.footage.keypoints.people import People
from ..bridge.clicked_keypoints import SOURCE as CLICKS
from ..bridge.track_keypoints import SOURCE as TRACKS
from ..bridge.track_keypoints import tracks_at
from ..shell.shown_frame import clip_index
from ..shell.takes import footage_of
from .assigned_tracks import assigned_tracks
from .evidence import clicked_points
from .keypoint_readings import keypoint_reading

Seen = list[tuple[str, tuple[float, float], float]]
"""Body point, place [px] and score of each point of the performer."""


@dataclass(frozen=True, eq=False)
class FrameKeypoints:
    """What one source sees in a frame: H people with N body points each."""

    source: str
    """Name of the detector; `clicks` and `tracks` for what a person clicked on or tracked."""
    names: tuple[str, ...]
    """(N,) the body points; those of clicks and tracks are the ones seen here."""
    pixel: Array
    """(H, N, 2) [px] of the footage as it is, NaN where a point is not seen."""
    score: Array
    """(H, N) confidence, 0 to 1; 0 where not seen."""

    is_tracked: bool = False
    """Whether they are motion tracks of the clip."""

    @property
    def seen_count(self) -> int:
        """How many points are seen of the person of whom most are."""
        return int(np.isfinite(self.pixel).all(axis=-1).sum(axis=-1).max(initial=0))


def keypoints_at(take: bpy.types.PropertyGroup, scene_frame: int) -> tuple[FrameKeypoints, ...]:
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


def clicks_at(take: bpy.types.PropertyGroup, scene_frame: int) -> FrameKeypoints:
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
