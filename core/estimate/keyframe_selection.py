"""Which found keyframes are worth having between posed ones."""

import numpy as np

from ..arrays import Array, chunks
from ..body.posture import Posture
from ..detect.keypoints import Keypoints, mirrored_point
from ..detect.performer import principal_keypoints
from ..markers.region_tracks import RegionTracks
from ..numerics.vectors import columns_at
from ..prior.keyframes import Keyframe, interpolate, leave_one_out_residuals
from ..terms.region_model import RegionModel
from .belief import FEWEST_POSED

CHUNK_FRAMES = 500


def select_keyframes(
    keyframes: tuple[Keyframe, ...],
    model: RegionModel,
    tracks: RegionTracks,
    fps: float,
    keypoints: Keypoints | None = None,
) -> tuple[Keyframe, ...]:
    """The posed keyframes, and those found ones that are better than interpolation between them."""
    posed = tuple(keyframe for keyframe in keyframes if keyframe.is_posed)
    compared = tuple(
        key for key in keyframes if key.is_posed or (key.matched is not None and not key.matched.is_composed)
    )
    if len(posed) < FEWEST_POSED or len(posed) == len(compared):
        return keyframes
    library_m = _library_error_m(compared, posed, model, fps)
    interpolation_error = _interpolation_error_squared_m(posed, model, tracks)
    if keypoints is not None and keypoints.seen.any():
        by_points = _keypoint_error_squared_m(posed, model, keypoints)
        # 10: Weight of the median keypoint of a frame, in coordinates of a marker: as much as five markers.
        columns = [by_points[:, None]] * 10
        interpolation_error = np.hstack([interpolation_error, *columns])
    kept = []
    for keyframe in keyframes:
        before = [other.index for other in posed if other.index <= keyframe.index]
        after = [other.index for other in posed if other.index >= keyframe.index]
        if keyframe not in compared or keyframe.matched is None or not before or not after:
            kept.append(keyframe)
            continue
        between = interpolation_error[before[-1] : after[0] + 1]
        seen = between[np.isfinite(between)]
        posed_m = float(np.sqrt(seen.mean())) if len(seen) else np.inf
        # 0.12: a library with a larger error along the line of sight holds another motion
        # 1.3: Largest ratio of the library's error to the interpolation's: it knows how the motion goes on.
        if library_m <= min(0.12, 1.3 * posed_m):
            kept.append(keyframe)
    return tuple(kept)


def _library_error_m(
    keyframes: tuple[Keyframe, ...], posed: tuple[Keyframe, ...], model: RegionModel, fps: float
) -> float:
    """Leave-one-out error of the library at the posed keyframes along the line of sight, RMS [m]."""
    body = model.body
    posture = Posture.stack([keyframe.posture for keyframe in posed])
    points = body.points(body.pose(posture))
    difference, weight = leave_one_out_residuals(keyframes, fps)
    foretold = body.points(body.pose(posture.plus(-difference)))
    sight = model.camera.sight(points, np.array([[keyframe.index] for keyframe in posed]))
    squared = np.mean(np.sum((foretold - points) * sight, axis=-1) ** 2, axis=-1)  # (P,)
    # 0.5: Least weight, in posed keyframes, that the library's error is divided by: too little evidence
    # excludes none.
    return float(np.sqrt(np.sum(weight * squared) / max(float(weight.sum()), 0.5)))


def _interpolation_error_squared_m(
    posed: tuple[Keyframe, ...], model: RegionModel, tracks: RegionTracks
) -> Array:
    """(F, 2 M) squared error of the interpolated keyframes against the regions [m²]; NaN where unseen.

    Their offset at the posed keyframes is how the markers sit, and is subtracted.
    """
    camera, frames = model.camera, tracks.frame_count
    if not model.placements:
        return np.zeros((frames, 0))
    prior = interpolate(posed, frames)
    offset = np.empty((frames, len(model.placements), 2))
    for frame in chunks(np.arange(frames), CHUNK_FRAMES):
        predicted = model.evaluate(model.body.pose(prior[frame]), frame)
        # 0.3: least visibility and quality of a region that counts
        trusted = np.minimum(predicted.visible, tracks.quality[frame]) > 0.3
        meters = camera.depth(prior[frame].translation, frame) / camera.focal_px
        apart = (predicted.centroid - tracks.centroid[frame]) * meters[:, None, None]
        offset[frame] = np.where(trusted[..., None], apart, np.nan)
    flat = offset.reshape(frames, -1)
    index = np.array([keyframe.index for keyframe in posed])
    usual = np.nan_to_num(flat[index])
    placement = [np.interp(np.arange(frames), index, column) for column in usual.T]
    return np.asarray((flat - np.stack(placement, axis=-1)) ** 2)


def _keypoint_error_squared_m(posed: tuple[Keyframe, ...], model: RegionModel, keypoints: Keypoints) -> Array:
    """(F,) squared error of the interpolated keyframes by the median keypoint, along an axis [m²].

    Offsets at the posed keyframes are the detector's, and are subtracted. Left and right may be exchanged.
    """
    body, camera, frames = model.body, model.camera, keypoints.frame_count
    prior, every = interpolate(posed, frames), np.arange(frames)
    seen = principal_keypoints(keypoints).pixel
    predicted, _ = camera.project(body.points(body.pose(prior)), every[:, None])
    meters = camera.depth(prior.translation, every) / camera.focal_px
    names = body.skeleton.point_names
    mirrored = seen[:, [names.index(mirrored_point(name)) for name in names]]
    index = np.array([keyframe.index for keyframe in posed])
    errors = []
    for pixel in (seen, mirrored):
        offset = (predicted - pixel) * meters[:, None, None]
        usual = np.nan_to_num(offset[index]).reshape(len(index), -1)
        placement = columns_at(every, index, usual)
        squared = 0.5 * ((offset - placement.reshape(offset.shape)) ** 2).sum(axis=-1)  # (F, P)
        some = np.isfinite(squared).any(axis=1)
        median = np.full(frames, np.nan)
        median[some] = np.nanmedian(squared[some], axis=1)
        errors.append(median)
    # 0.02: Error of a usual keypoint along each axis of the image, beside one that is the same at all times
    # [m].
    return np.maximum(np.fmin(*errors) - 0.02**2, 0.0)
