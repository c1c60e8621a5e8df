"""Reading a take's footage: one pass over its clip, with the markers expected near the keyframes."""

from dataclasses import replace

import numpy as np

from ..arrays import chunks
from ..markers.reading import Reading, read_clip
from ..markers.region_tracks import ExpectedRegions
from ..prior.keyframes import interpolate
from ..progress import Job, Progress, within
from ..terms.region_model import MarkerPlacement, RegionModel
from ..video.album import Watch
from .clip_check import check_frame_count, check_in_front, clip_notes, open_clip
from .take import Take

FOLLOWING, READING = "Following the markers", "Reading the clip"
EXPECTED_RADIUS_M = 0.45
"""Radius around a marker of the interpolated keyframes within which it is searched first."""
RADIUS_GROWTH_M_PER_S = 3.0
"""Growth of that radius farther from a keyframe than ..."""
KNOWN_S = 0.2
"""... this: a limb may have swung there and back in between, and before the first keyframe and after the last
the posture is only held [s]."""


def read_footage(
    take: Take, kept: Reading | None = None, watch: Watch | None = None, stage: str = READING
) -> Job[Reading]:
    """Read a take's clip: tracks of its markers, notes, and an album where the camera stands still.

    `kept` and `watch` are as in `read_clip`; `stage` is shown meanwhile where no markers are followed.
    """
    yield Progress("Opening the clip", 0.0)
    clip = open_clip(take)
    check_in_front(take)
    expected = (
        expected_regions(take, take.frame_count or clip.frame_count) if len(take.keyframes) > 1 else None
    )
    # Before a camera that moves, no background stands still to tell the performer from.
    with_album = take.contours and not take.camera.is_moving
    job = read_clip(clip, take.markers, expected, with_album, kept, take.ignored_regions, watch)
    reading = yield from within(FOLLOWING if take.markers else stage, job, 0.0, 1.0)
    check_frame_count(take, reading.tracks.frame_count, clip.frame_count)
    return replace(reading, notes=clip_notes(take, clip, reading))


def expected_regions(take: Take, frame_count: int) -> ExpectedRegions:
    """Regions around each marker of the interpolated keyframes, with a generous radius."""
    prior = interpolate(take.keyframes, frame_count)
    model = average_model(take)
    center = np.empty((frame_count, len(take.markers), 2))
    for frame in chunks(np.arange(frame_count), 500):
        center[frame] = model.evaluate(take.body.pose(prior[frame]), frame).centroid
    depth = take.camera.depth(prior.translation, np.arange(frame_count))
    frame, posed = np.arange(frame_count), np.array(sorted(take.keyframe_indices))
    away = np.abs(frame[:, None] - posed).min(axis=1) / take.fps
    reach = EXPECTED_RADIUS_M + RADIUS_GROWTH_M_PER_S * np.maximum(away - KNOWN_S, 0.0)
    radius = reach * take.camera.pixels_per_meter(depth)
    # To a fraction of a pixel, so that a posture read from Blender once more expects the same.
    center, radius = np.round(64.0 * center) / 64.0, np.round(64.0 * radius) / 64.0
    return ExpectedRegions(center, np.repeat(radius[:, None], len(take.markers), axis=1))


def average_model(take: Take) -> RegionModel:
    """The markers as worn by an average performer."""
    placements = tuple(MarkerPlacement.usual(segment) for segment in take.marker_segments)
    return RegionModel(take.body, take.camera, placements)
