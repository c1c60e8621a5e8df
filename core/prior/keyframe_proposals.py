"""V_sum, the summed speed of the markers in the image (paper, eq. 8), and the keyframes proposed by it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import median_filter

from ..arrays import Array, IndexArray
from ..body.human import limb_of
from ..detect.keypoints import Keypoints
from ..errors import InputError
from ..markers.region_tracks import RegionTracks
from ..numerics.vectors import columns_at, gaussian, usual_step
from ..progress import Part
from ..video.album import Album, picture_motion

SMOOTHING_FRAMES = 1.0


def marker_speed(tracks: RegionTracks) -> Array:
    """V_sum(t), the sum of the speeds of the markers' centroids in the image (paper, eq. 8).

    The text calls it a square sum, the equation is a sum of speeds; the equation is followed. A hidden
    marker is interpolated linearly between its detections; before the first and after the last it keeps
    its nearest known speed, so that occlusion alone makes no minimum. A marker detected in fewer than two
    frames adds nothing.

    (F,) [px per frame of the clip's median duration]; uneven time stamps are respected.
    """
    time = frame_times(tracks.time_s)
    total = np.zeros(tracks.frame_count)
    for marker in range(len(tracks.names)):
        total += point_speed(tracks.centroid[:, marker], time)
    return gaussian(total, SMOOTHING_FRAMES)


def frame_times(time_s: Array) -> Array:
    """Time stamps (F,) in median frame durations; a stamp that does not advance counts as one duration."""
    step = np.diff(time_s)
    advancing = np.isfinite(step) & (step > 0.0)
    return np.concatenate([[0.0], np.cumsum(np.where(advancing, step / usual_step(time_s), 1.0))])


def point_speed(centroid: Array, time: Array) -> Array:
    """Speed (F,) of one centroid (F, 2) [px]; zero if it is detected in fewer than two frames."""
    seen = np.flatnonzero(np.all(np.isfinite(centroid), axis=-1))
    if len(seen) < 2:
        return np.zeros(len(time))
    within = slice(seen[0], seen[-1] + 1)
    path = columns_at(time[within], time[seen], centroid[seen])
    speed = np.linalg.norm(np.gradient(path, time[within], axis=0), axis=-1)
    return np.asarray(np.interp(np.arange(len(time)), np.arange(seen[0], seen[-1] + 1), speed))


JITTER_S = 0.067  # smoothing of keypoints and pictures: a detector's jitter is faster
FROM_PICTURES = "no marker or keypoint is seen, so the speed is how much the pictures change"
FROM_NOTHING = "no marker or keypoint is seen and the camera moves, so keyframes are spaced evenly"


@dataclass(frozen=True, eq=False)
class EvidenceSpeed:
    """V_sum, and what it was made from."""

    values: Array  # (F,) [px per frame]
    note: str = ""  # what had to be used where neither markers nor keypoints are seen, for people


def evidence_speed(
    tracks: RegionTracks, segments: tuple[str, ...], keypoints: Keypoints, album: Album | None = None
) -> Part[EvidenceSpeed]:
    """The summed speed of the performer's parts in the image."""
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
    half = max(1, round(0.5 * 0.17 / usual_step(time_s)))
    calm = median_filter(path, size=(2 * half + 1, 1), mode="nearest")
    cleaned = np.full((len(frames), 2), np.nan)
    cleaned[within] = gaussian(calm, JITTER_S / usual_step(time_s))
    return cleaned


def propose_keyframes(
    speed: ArrayLike, count: int | None = None, largest_gap: int | None = None
) -> IndexArray:
    """Propose keyframes: evenly spaced frames, each moved to a minimum of the speed nearby.

    The first and the last frame are always included.

    `count`: by default 10 per 100 frames, and more where `largest_gap` wants it, which is 1.5 even gaps by
    default.

    Raises:
        InputError: Fewer than two frames, a count that is not between 2 and F, or a gap below 1.
    """
    V = np.asarray(speed, dtype=np.float64)
    frames = len(V)
    if frames < 2:
        raise InputError(f"the clip has {frames} frame(s); keyframes can be proposed for 2 or more")
    if count is not None and not 2 <= count <= frames:
        raise InputError(
            f"keyframe count is {count}; a count between 2 and the clip's {frames} frames is valid"
        )
    if largest_gap is not None and largest_gap < 1:
        raise InputError(f"largest keyframe gap is {largest_gap} frames; a gap of 1 frame or more is valid")
    wanted = count if count is not None else round(frames * 10.0 / 100.0)
    if largest_gap is not None:
        wanted = max(wanted, math.ceil((frames - 1) / largest_gap) + 1)
    even = np.rint(np.linspace(0, frames - 1, min(max(wanted, 2), frames))).astype(np.intp)
    gap = (frames - 1) / (len(even) - 1)
    largest_gap = largest_gap if largest_gap is not None else math.ceil(1.5 * gap)
    # Inner keyframes move to the lowest minimum within reach.
    V = np.where(np.isfinite(V), V, np.inf)
    padded = np.concatenate([[np.inf], V, [np.inf]])
    minimum = np.isfinite(V) & (V <= padded[:-2]) & (V <= padded[2:])
    spacing = np.diff(even)
    # Within this reach the next keyframe's evenly spaced frame stays allowed for any choice of this one.
    reach = min(int(0.35 * spacing.min()), largest_gap - int(spacing.max()))
    chosen = even.copy()
    for i in range(1, len(even) - 1):
        last = min(even[i] + reach, chosen[i - 1] + largest_gap)
        window = np.arange(even[i] - reach, last + 1)
        window = window[minimum[window]]
        if len(window):
            chosen[i] = min(window, key=lambda frame: (V[frame], abs(frame - even[i])))
    return chosen
