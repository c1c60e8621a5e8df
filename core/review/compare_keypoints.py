"""Comparison of a take's keypoints with the places where its motion puts them."""

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body, Pose
from ..estimate.reconstruct import Reconstruction
from .compared_keypoints import ComparedKeypoints

LEAST_STD_SHARE = 0.005
"""Least standard deviation of a keypoint, as a share of the picture's width: about a pixel in 320."""
OUTLIER = 4.0
"""Distance in standard deviations from which a keypoint is not believed."""


def compare_keypoints(reconstruction: Reconstruction) -> ComparedKeypoints:
    """The performer's keypoints beside the motion's, with what the estimate made of them.

    Args:
        reconstruction: The result of `reconstruct`.
    """
    keypoints, motion = reconstruction.keypoints, reconstruction.motion
    if not keypoints.names:
        return ComparedKeypoints.none(len(motion.time_s))
    pose, camera = motion.body.pose(motion.posture), reconstruction.model.camera
    frame = np.arange(len(motion.time_s))
    points = [_place(motion.body, pose, motion.points, name) for name in keypoints.names]
    predicted = camera.project(np.stack(points, axis=1), frame[:, None])[0]
    offset = keypoints.pixel - predicted
    known = offset[list(motion.keyframe_indices)]
    center = _median(known)
    spread = 1.48 * _median(np.abs(known - center)).mean(axis=-1)
    spread = np.maximum(np.nan_to_num(spread), LEAST_STD_SHARE * reconstruction.tracks.size[0])
    predicted = predicted + np.nan_to_num(center)
    distance = np.linalg.norm(keypoints.pixel - predicted, axis=-1)
    expected = np.broadcast_to(2.0 * spread, distance.shape)
    return ComparedKeypoints(
        keypoints.names,
        keypoints.sources,
        keypoints.pixel,
        predicted,
        keypoints.score,
        distance,
        expected,
        distance > OUTLIER * expected,
        np.zeros(distance.shape, dtype=bool),
    )


def _median(values: Array) -> Array:
    """Medians over the first axis; NaN where all are."""
    known = np.isfinite(values).any(axis=0)
    filled = np.where(known, values, 0.0)
    return np.asarray(np.where(known, np.nanmedian(filled, axis=0), np.nan))


def _place(body: Body, pose: Pose, points: Array, name: str) -> Array:
    """(F, 3) where a body point lies, NaN where that is not known."""
    at = dict(zip(body.skeleton.point_names, np.swapaxes(points, 0, 1), strict=True))
    if name in at:
        return at[name]
    pairs = {"neck": "shoulder", "pelvis": "hip"}
    if name in pairs:
        return np.asarray(0.5 * (at[f"{pairs[name]}.L"] + at[f"{pairs[name]}.R"]))
    return np.full(points[:, 0].shape, np.nan)
