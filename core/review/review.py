"""Review of a motion: markers, keypoints, points, confidence, and frames worth another keyframe."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, IndexArray
from ..body.kinematics import Pose
from ..estimate.reconstruct import Reconstruction
from ..markers.regions import CORNERS, ellipse_outline
from ..progress import Job, Part, within
from ..take.take import Take
from ..terms.region_model import RegionModel
from ..terms.regions import NOISE, limb_widths
from .compared_keypoints import ComparedKeypoints
from .confidence import TOLERANCE_SHARE, confidence, expected_covariance, misfits
from .frame_evidence import (
    ContourSight,
    MarkerSight,
    believed_misfits,
    compare_keypoints,
    contour_sight,
    frame_evidence,
)
from .weak_frames import Reason, WeakFrame, find_weak_frames

__all__ = ["Reason", "Review", "WeakFrame", "review"]

STAGE = "Judging the motion"
CHUNK_FRAMES = 100  # so few that a job can be canceled within some hundredths of a second
NAMES = ("marker_names", "point_names")
KINDS: Mapping[str, type] = MappingProxyType(
    {**dict.fromkeys(NAMES, np.str_), **dict.fromkeys(("observed", "predicted", "contours"), np.float32)}
)
"""Kinds of arrays in a cache that numpy would not choose: large ones are only drawn, in single precision."""


@dataclass(frozen=True, eq=False)
class Review:
    """Review data of a motion of F frames, M markers and 13 points; NaN where there is none."""

    frames: Array  # (F,) scene frames, fractional for variable frame rate
    size: tuple[int, int]  # width and height of the picture [px]
    marker_names: tuple[str, ...]
    point_names: tuple[str, ...]
    observed: Array  # (F, M, K, 2) closed outline of each region seen [px]: the even ellipse of equal moments
    predicted: Array  # (F, M, K, 2) the same of each marker's visible part as the motion predicts it [px]
    points: Array  # (F, 13, 3) principal points in the world [m]
    image_points: Array  # (F, 13, 2) the same in the picture, through the calibrated lens [px]
    sigma_m: Array  # (F, 13) root of the trace of each point's covariance [m]; NaN without
    reprojection_px: Array  # (F, M) predicted from observed centroids [px]; NaN where not compared
    nearness: Array  # (F,) degree to which a keyframe is near, 0 to 1
    speed: Array  # (F,) V_sum [px per frame]
    confidence: Array  # (F,) from 0 to 1; NaN for a method without uncertainty
    keyframe_indices: IndexArray  # (K,) frame indices of the keyframes
    weak_frames: tuple[WeakFrame, ...]  # frames worth another keyframe, the worst first
    contours: Array  # (F, L, S, 2) predicted contour lines [px], where no marker shows the fit
    keypoints: ComparedKeypoints  # N of the performer; none in a review kept before there were any

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """All fields as plain arrays for `from_arrays`; none needs pickling."""
        arrays: dict[str, NDArray[Any]] = {}
        for field in fields(self):
            if field.name in ("weak_frames", "keypoints"):
                continue
            kind = KINDS.get(field.name)
            arrays[field.name] = np.asarray(getattr(self, field.name), dtype=kind)
        weak = self.weak_frames
        arrays["weak_index"] = np.array([frame.index for frame in weak], dtype=np.int64)
        arrays["weak_reason"] = np.array([str(frame.reason) for frame in weak], dtype=np.str_)
        arrays["weak_strength"] = np.array([frame.strength for frame in weak], dtype=np.float64)
        markers = [-1 if frame.marker is None else frame.marker for frame in weak]
        arrays["weak_marker"] = np.array(markers, dtype=np.int64)
        arrays["weak_point"] = np.array([frame.point or "" for frame in weak], dtype=np.str_)
        return {**arrays, **self.keypoints.to_arrays()}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> "Review":
        """Restore a review, also of a version that knew no keypoints.

        Raises:
            KeyError: An array is missing.
            ValueError: A reason is unknown.
        """
        others = (*NAMES, "size", "keyframe_indices", "weak_frames", "keypoints", "contours")
        plain = {
            field.name: np.asarray(arrays[field.name], dtype=np.float64)
            for field in fields(cls)
            if field.name not in others
        }
        width, height = arrays["size"].tolist()
        return cls(
            size=(int(width), int(height)),
            marker_names=tuple(arrays["marker_names"].tolist()),
            point_names=tuple(arrays["point_names"].tolist()),
            keyframe_indices=np.asarray(arrays["keyframe_indices"], dtype=np.intp),
            weak_frames=_weak_frames(arrays),
            contours=_contours(arrays, len(plain["frames"])),
            keypoints=ComparedKeypoints.from_arrays(arrays, len(plain["frames"])),
            **plain,
        )


def _contours(arrays: Mapping[str, NDArray[Any]], frames: int) -> Array:
    if "contours" not in arrays:
        return ContourSight.none(frames).lines
    return np.asarray(arrays["contours"], dtype=np.float64)


def _weak_frames(arrays: Mapping[str, NDArray[Any]]) -> tuple[WeakFrame, ...]:
    names = ("weak_index", "weak_reason", "weak_strength", "weak_marker")
    columns = [arrays[name].tolist() for name in names]
    points = arrays["weak_point"].tolist() if "weak_point" in arrays else [""] * len(columns[0])
    return tuple(
        WeakFrame(index, Reason(reason), strength, None if marker < 0 else marker, point or None)
        for index, reason, strength, marker, point in zip(*columns, points, strict=True)
    )


def review(take: Take, reconstruction: Reconstruction, scene_frames: Array) -> Job[Review]:
    """Review a reconstruction; `scene_frames` (F,) are those of the clip's frames."""
    motion, tracks, model = reconstruction.motion, reconstruction.tracks, reconstruction.model
    frame = np.arange(tracks.frame_count)
    pose, there = take.body.pose(motion.posture), motion.there
    predicted, offset = yield from within(STAGE, _predictions(model, pose, tracks.centroid), 0.0, 0.5)
    predicted[~there], offset[~there] = np.nan, np.nan
    contours = yield from within(STAGE, contour_sight(reconstruction), 0.5, 1.0)
    noise, width = NOISE, limb_widths(model, motion.posture.translation, frame)
    variance = noise.surface_std(width)[..., 0] ** 2 + noise.bias_std(width)[..., 0] ** 2
    misfit = misfits(offset, np.sqrt(noise.pixel_std_px**2 + variance))
    keypoints = compare_keypoints(reconstruction)
    moved = np.linalg.norm(motion.points - reconstruction.interpolation.points, axis=-1)
    believed_misfit = believed_misfits(misfit, contours, keypoints)
    expected = expected_covariance(motion.point_covariance, moved, believed_misfit)
    believed = confidence(expected, TOLERANCE_SHARE * take.body.actor.stature_m)
    # Largest error that counts, as a share of the performer's stature: beyond it a point is simply wrong.
    wrong = 0.1 * take.body.actor.stature_m
    squared = np.minimum(np.trace(expected, axis1=-2, axis2=-1), wrong**2).mean(axis=1)
    index = np.array(motion.keyframe_indices, dtype=np.intp)
    evidence = frame_evidence(
        np.where(there, np.where(np.isfinite(squared), squared, 1.0), 0.0),
        np.where(there, believed, 1.0),  # where nobody is there no keyframe is missing
        reconstruction.speed,
        MarkerSight(take.marker_segments, np.where(tracks.visible, tracks.quality, 0.0), misfit),
        contours,
        keypoints,
    )
    return Review(
        frames=np.asarray(scene_frames, dtype=np.float64),
        size=tracks.size,
        marker_names=tracks.names,
        point_names=take.body.skeleton.point_names,
        observed=ellipse_outline(tracks.centroid, tracks.second_moment),
        predicted=predicted,
        points=motion.points,
        image_points=model.camera.project(motion.points, frame[:, None])[0],
        sigma_m=motion.sigma_m,
        reprojection_px=offset,
        nearness=motion.diagnostics["nearness"],
        speed=reconstruction.speed,
        confidence=believed,
        keyframe_indices=index,
        weak_frames=find_weak_frames(evidence, index),
        contours=contours.lines,
        keypoints=keypoints,
    )


def _predictions(model: RegionModel, pose: Pose, centroid: Array) -> Part[tuple[Array, Array]]:
    """Predicted outlines (F, M, K, 2) and the centroids' distances (F, M) from observed ones [px]."""
    outlines = np.full((*centroid.shape[:2], CORNERS, 2), np.nan)
    distance = np.full(centroid.shape[:2], np.nan)
    for first in range(0, len(centroid), CHUNK_FRAMES):
        yield first / len(centroid)
        chunk = slice(first, first + CHUNK_FRAMES)
        frame = np.arange(len(centroid))[chunk]
        predicted = model.evaluate(pose[chunk], frame)
        seen = predicted.visible > NOISE.least_visible
        shape = ellipse_outline(predicted.centroid, predicted.second_moment)
        outlines[chunk] = np.where(seen[..., None, None], shape, np.nan)
        apart = np.linalg.norm(predicted.centroid - centroid[chunk], axis=-1)
        distance[chunk] = np.where(seen, apart, np.nan)
    return outlines, distance
