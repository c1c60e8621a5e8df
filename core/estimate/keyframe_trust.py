"""Evidence of posed and matched keyframes together: only posed ones calibrate markers and lens.

Placements, lens and posing error are calibrated on keyframes that a person has posed, in the picture at
least. Matched ones err by more than any of these, and all in the same direction: calibrated on them, sleeves
would make up for another performer's gait.
"""

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray, chunks
from ..body.posture import Posture
from ..detect.keypoints import Keypoints, mirrored_point
from ..detect.performer import principal_keypoints
from ..markers.region_tracks import RegionTracks
from ..numerics.vectors import columns_at
from ..prior.keyframes import Keyframe, interpolate, leave_one_out_residuals
from ..terms.region_model import RegionModel
from ..terms.regions import RegionNoise
from .clip_problem import KeyframeEvidence, uncalibrated
from .keyframe_error import match_covariance, picture_information, posing_covariance
from .keyframe_evidence import SeenAtKeyframes, read_keyframes

FEWEST_POSED = 2  # fewer posed keyframes calibrate nothing


def calibrating(matched: BoolArray, corrected: BoolArray) -> BoolArray:
    """(K,) keyframes by which a clip's evidence is judged: those posed, and those put right in the picture.

    Of the latter two count as one: a person puts right what is wrong there, not what is usual.
    """
    posed = ~matched
    enough = posed.sum() + corrected.sum() // 2 >= FEWEST_POSED
    return posed | corrected if enough else posed


def read_mixed_keyframes(
    model: RegionModel, noise: RegionNoise, at: SeenAtKeyframes, match_scale: Array, corrected: BoolArray
) -> Generator[None, None, KeyframeEvidence]:
    """Evidence of keyframes of which some may be matched.

    `match_scale` (K,): size of the matched ones' error, relative to a usual difference between performers; 0
    for posed ones; `corrected` (K,): which of these a person vouches for in the picture, which calibrates
    too.
    """
    if not match_scale.any():
        return (yield from read_keyframes(model, noise, at))
    posed = np.flatnonzero(match_scale == 0.0)
    seen = np.flatnonzero(calibrating(match_scale > 0.0, corrected))
    information = np.linalg.inv(match_covariance(at.posture, model.camera, at.frame))
    information /= np.where(match_scale > 0.0, match_scale, 1.0)[:, None, None] ** 2
    if len(seen) >= FEWEST_POSED:
        posing = posing_covariance(model.body, model.body.pose(at.posture))
        if corrected.any():
            there = at[np.flatnonzero(corrected)]
            pictured = picture_information(model.body, model.camera, there.posture, there.frame)
            posing[corrected] = np.linalg.inv(information[corrected] + pictured)
            if at.points is not None:  # a found depth says nothing of a detector's guess
                depth_m = np.where(corrected[:, None], np.nan, at.points.depth_m)
                at = replace(at, points=replace(at.points, depth_m=depth_m))
        evidence = yield from read_keyframes(model, noise, replace(at, posing=posing)[seen])
        information[posed] = evidence.information[np.isin(seen, posed)]
        return replace(evidence, information=information)
    if len(posed):
        information[posed] = np.linalg.inv(posing_covariance(model.body, model.body.pose(at.posture[posed])))
    evidence = replace(uncalibrated(model), information=information)
    return evidence if at.keypoints is None else replace(evidence, keypoints=at.keypoints)


@dataclass(frozen=True)
class SelectionOptions:
    """When a matched keyframe is better than interpolation between posed ones."""

    # a library with a larger error along the line of sight holds another motion
    largest_library_error_m: float = 0.12
    # Largest ratio of the library's error to the interpolation's: it knows how the motion goes on.
    largest_ratio: float = 1.3
    # Least weight, in posed keyframes, that the library's error is divided by: too little evidence excludes
    # none.
    least_weight: float = 0.5
    least_trusted: float = 0.3  # least visibility and quality of a region that counts
    # Weight of the median keypoint of a frame, in coordinates of a marker: as much as five markers.
    keypoint_columns: int = 10
    # Error of a usual keypoint along each axis of the image, beside one that is the same at all times [m].
    keypoint_error_m: float = 0.02


SELECTION = SelectionOptions()
CHUNK_FRAMES = 500


def select_keyframes(
    keyframes: tuple[Keyframe, ...],
    model: RegionModel,
    tracks: RegionTracks,
    fps: float,
    keypoints: Keypoints | None = None,
) -> tuple[Keyframe, ...]:
    """The posed keyframes, and those matched ones that are better than interpolation between them."""
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
        columns = [by_points[:, None]] * SELECTION.keypoint_columns
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
        if library_m <= min(SELECTION.largest_library_error_m, SELECTION.largest_ratio * posed_m):
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
    return float(np.sqrt(np.sum(weight * squared) / max(float(weight.sum()), SELECTION.least_weight)))


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
        trusted = np.minimum(predicted.visible, tracks.quality[frame]) > SELECTION.least_trusted
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
    return np.maximum(np.fmin(*errors) - SELECTION.keypoint_error_m**2, 0.0)
