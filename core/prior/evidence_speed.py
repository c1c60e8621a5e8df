"""V_sum of whatever shows the performer: how fast markers, keypoints or the pictures themselves move.

With markers alone it is the paper's sum (eq. 8). Keypoints are many, and each jitters: their paths are
cleaned of outliers and smoothed, and each of the five parts of the body counts once, by the mean of all that
shows it, markers included. Without either the change of the pictures stands for it.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from ..arrays import Array
from ..body.limbs import limb_of
from ..footage.clips.album import Album
from ..footage.keypoints.keypoints import Keypoints
from ..footage.picture_motion import picture_motion
from ..footage.region_tracks import RegionTracks
from ..numerics.smoothing import columns_at, gaussian, usual_step
from ..progress import Part
from .marker_speed import SMOOTHING_FRAMES, frame_times, marker_speed, point_speed

OUTLIER_S = 0.17
"""Time of which a keypoint's path is the median: less than half of it a detector may be wrong."""
JITTER_S = 0.067
"""Standard deviation of the smoothing of keypoints and pictures: a detector's jitter of pixels is faster."""
FROM_PICTURES = "no marker or keypoint is seen, so the speed is how much the pictures change"
FROM_NOTHING = "no marker or keypoint is seen and the camera moves, so keyframes are spaced evenly"


@dataclass(frozen=True, eq=False)
class EvidenceSpeed:
    """V_sum, and what it was made from."""

    values: Array
    """(F,) [px per frame]."""
    note: str = ""
    """What else than markers and keypoints had to be used, for people; empty where one of them is seen."""


def evidence_speed(
    tracks: RegionTracks, segments: tuple[str, ...], keypoints: Keypoints, album: Album | None = None
) -> Part[EvidenceSpeed]:
    """The summed speed of the performer's parts in the image.

    Args:
        tracks: The markers' regions, of F frames.
        segments: The segment each marker is bound to.
        keypoints: The performer's keypoints.
        album: Pictures of the clip; None where there are none.

    Yields:
        The fraction done.
    """
    if keypoints.seen.any():
        return EvidenceSpeed(_speed_of_parts(tracks, segments, keypoints))
    if tracks.visible.any():
        return EvidenceSpeed(marker_speed(tracks))
    if album is None:
        return EvidenceSpeed(np.zeros(tracks.frame_count), FROM_NOTHING)
    moved = yield from picture_motion(album, tracks.frame_count)
    return EvidenceSpeed(gaussian(moved, JITTER_S / usual_step(tracks.time_s)), FROM_PICTURES)


def _speed_of_parts(tracks: RegionTracks, segments: tuple[str, ...], keypoints: Keypoints) -> Array:
    """(F,) sum over the parts of the body of the mean speed of what shows each."""
    time = frame_times(tracks.time_s)
    parts: dict[str, list[tuple[float, Array]]] = {}
    for marker, segment in enumerate(segments):
        share = float(tracks.visible[:, marker].mean())
        parts.setdefault(limb_of(segment), []).append((share, point_speed(tracks.centroid[:, marker], time)))
    for index, name in enumerate(keypoints.names):
        path = _cleaned(keypoints.pixel[:, index], tracks.time_s)
        share = float(keypoints.score[:, index].mean())
        parts.setdefault(limb_of(name), []).append((share, point_speed(path, time)))
    total = np.zeros(tracks.frame_count)
    for speeds in parts.values():
        weight = sum(share for share, _ in speeds)
        if weight > 0.0:
            total += sum((share * speed for share, speed in speeds), np.zeros(len(total))) / weight
    return gaussian(total, SMOOTHING_FRAMES)


def _cleaned(pixel: Array, time_s: Array) -> Array:
    """A path (F, 2) without outliers and jitter, interpolated where it is not seen; NaN outside."""
    seen = np.flatnonzero(np.isfinite(pixel).all(axis=-1))
    if len(seen) < 2:
        return pixel
    within = np.arange(seen[0], seen[-1] + 1)
    frames = np.arange(len(pixel))
    path = columns_at(within, seen, pixel[seen])
    half = max(1, round(0.5 * OUTLIER_S / usual_step(time_s)))
    calm = median_filter(path, size=(2 * half + 1, 1), mode="nearest")
    cleaned = np.full((len(frames), 2), np.nan)
    cleaned[within] = gaussian(calm, JITTER_S / usual_step(time_s))
    return cleaned
