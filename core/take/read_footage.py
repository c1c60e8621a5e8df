"""Reading a take's footage: its clip gone through once, with the keyframes to tell where markers are."""

from dataclasses import replace

import numpy as np

from ..arrays import chunks
from ..footage.read_clip import read_clip
from ..footage.reading import Reading
from ..footage.region_tracks import ExpectedRegions
from ..observation.regions import MarkerPlacement, RegionModel
from ..prior.interpolation import interpolate
from ..progress import Job, Progress, within
from .clip_check import check_frame_count, check_in_front, open_clip
from .clip_notes import clip_notes
from .take import Take

FOLLOWING = "Following the markers"
EXPECTED_RADIUS_M = 0.45
"""How far a marker may lie from where the interpolated keyframes put it, to be searched there first."""
STRAYED_M_PER_S = 3.0
"""How much farther, before the first keyframe and after the last, where the posture is only held."""
CHUNK_FRAMES = 500


def read_footage(take: Take, kept: Reading | None = None) -> Job[Reading]:
    """Read what is to be read of a take's clip.

    Args:
        take: A take; keyframes tell where its markers are looked for first, and are not needed.
        kept: What was read before, of whatever clip; it is used as far as it still holds (see `read_clip`).

    Yields:
        Progress.

    Returns:
        The same as without `kept`.

    Raises:
        InputError: The clip cannot be used, or a color matches nothing in it.
    """
    yield Progress("Opening the clip", 0.0)
    clip = open_clip(take)
    check_in_front(take)
    expected = (
        expected_regions(take, take.frame_count or clip.frame_count) if len(take.keyframes) > 1 else None
    )
    # Before a camera that moves, no background stands still to tell the performer from.
    with_album = not take.camera.is_moving
    reading = yield from within(
        FOLLOWING, read_clip(clip, take.markers, expected, with_album, kept), 0.0, 1.0
    )
    check_frame_count(take, reading.tracks.frame_count, clip.frame_count)
    return replace(reading, notes=clip_notes(take, clip, reading))


def expected_regions(take: Take, frame_count: int) -> ExpectedRegions:
    """Where the interpolated keyframes put each marker, with a generous radius."""
    prior = interpolate(take.keyframes, frame_count)
    model = average_model(take)
    center = np.empty((frame_count, len(take.markers), 2))
    for frame in chunks(np.arange(frame_count), CHUNK_FRAMES):
        center[frame] = model.evaluate(take.body.pose(prior[frame]), frame).centroid
    depth = take.camera.depth(prior.translation, np.arange(frame_count))
    posed = take.keyframe_indices
    beyond = np.maximum(np.arange(frame_count) - max(posed), min(posed) - np.arange(frame_count)).clip(0)
    reach = EXPECTED_RADIUS_M + STRAYED_M_PER_S * beyond / take.fps
    radius = reach * take.camera.focal_px / np.maximum(depth, 0.1)
    # To a fraction of a pixel, so that a posture read from Blender once more expects the same.
    center, radius = np.round(64.0 * center) / 64.0, np.round(64.0 * radius) / 64.0
    return ExpectedRegions(center, np.repeat(radius[:, None], len(take.markers), axis=1))


def average_model(take: Take) -> RegionModel:
    """The markers as they sit on an average performer."""
    placements = tuple(MarkerPlacement.usual(segment) for segment in take.marker_segments)
    return RegionModel(take.body, take.camera, placements)
