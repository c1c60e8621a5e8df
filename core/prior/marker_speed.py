"""V_sum, the summed speed of the markers in the image (paper, eq. 8)."""

import numpy as np

from ..arrays import Array
from ..footage.region_tracks import RegionTracks
from ..numerics.smoothing import columns_at, gaussian

SMOOTHING_FRAMES = 1.0


def marker_speed(tracks: RegionTracks, smoothing_frames: float = SMOOTHING_FRAMES) -> Array:
    """V_sum(t), the sum of the speeds of the markers' centroids in the image (paper, eq. 8).

    The text calls it a square sum, the equation is a sum of speeds; the equation is followed. A hidden
    marker is interpolated linearly between its detections; before the first and after the last it keeps
    its nearest known speed, so that occlusion alone makes no minimum. A marker detected in fewer than two
    frames adds nothing.

    Args:
        tracks: F frames of M regions; uneven time stamps are respected.
        smoothing_frames: Standard deviation of a Gaussian filter over the sum [frames]; 0 for none.

    Returns:
        (F,) [px per frame of the clip's median duration].
    """
    time = frame_times(tracks.time_s)
    total = np.zeros(tracks.frame_count)
    for marker in range(len(tracks.names)):
        total += point_speed(tracks.centroid[:, marker], time)
    return gaussian(total, smoothing_frames)


def frame_times(time_s: Array) -> Array:
    """Time stamps (F,) in median frame durations; a stamp that does not advance counts as one duration."""
    step = np.diff(time_s)
    advancing = np.isfinite(step) & (step > 0.0)
    usual = float(np.median(step[advancing])) if advancing.any() else 1.0
    return np.concatenate([[0.0], np.cumsum(np.where(advancing, step / usual, 1.0))])


def point_speed(centroid: Array, time: Array) -> Array:
    """Speed (F,) of one centroid (F, 2) [px]; zero if it is detected in fewer than two frames."""
    seen = np.flatnonzero(np.all(np.isfinite(centroid), axis=-1))
    if len(seen) < 2:
        return np.zeros(len(time))
    within = slice(seen[0], seen[-1] + 1)
    path = columns_at(time[within], time[seen], centroid[seen])
    speed = np.linalg.norm(np.gradient(path, time[within], axis=0), axis=-1)
    return np.asarray(np.interp(np.arange(len(time)), np.arange(seen[0], seen[-1] + 1), speed))
