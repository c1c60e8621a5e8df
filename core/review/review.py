"""Review of a motion: markers, keypoints, points, confidence, and frames worth another keyframe."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, IndexArray
from ..body.fingers import SURE
from ..body.kinematics import Pose
from ..estimate.reconstruct import Reconstruction
from ..markers.regions import CORNERS, ellipse_outline
from ..progress import Job, Part, within
from ..take.take import Take
from ..terms.head import POINTS_STD_RAD
from ..terms.region_model import RegionModel
from ..terms.regions import NOISE, limb_widths
from .compared_keypoints import Arrays, ComparedKeypoints, from_arrays, to_arrays
from .confidence import TOLERANCE_SHARE, confidence, expected_covariance, misfits
from .frame_evidence import (
    ContourSight,
    Sight,
    believed_misfits,
    compare_keypoints,
    contour_sight,
    frame_evidence,
)
from .weak_frames import TURNED, Reason, WeakFrame, find_weak_frames

__all__ = ["Reason", "Review", "WeakFrame", "review"]

STAGE = "Judging the motion"
DRAWN = ("observed", "predicted", "contours")
WEAK = ("index", "reason", "strength", "marker", "point")


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
    speed: Array  # (F,) V_sum [px per frame]
    confidence: Array  # (F,) from 0 to 1; NaN for a method without uncertainty
    keyframe_indices: IndexArray  # (K,) frame indices of the keyframes
    weak_frames: tuple[WeakFrame, ...]  # frames worth another keyframe, the worst first
    contours: Array  # (F, L, S, 2) predicted contour lines [px], where no marker shows the fit
    keypoints: ComparedKeypoints  # N of the performer; none in a review kept before there were any
    unsure: BoolArray  # (F, 3) where the turn of a hand, or of the head, as `TURNED`, is hardly seen

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """All fields as plain arrays for `from_arrays`."""
        weak = self.weak_frames
        return {
            **to_arrays(self, DRAWN),
            "weak_index": np.array([frame.index for frame in weak], dtype=np.int64),
            "weak_reason": np.array([str(frame.reason) for frame in weak], dtype=np.str_),
            "weak_strength": np.array([frame.strength for frame in weak], dtype=np.float64),
            "weak_marker": np.array([-1 if each.marker is None else each.marker for each in weak], np.int64),
            "weak_point": np.array([frame.point or "" for frame in weak], dtype=np.str_),
            **self.keypoints.to_arrays(),
        }

    @classmethod
    def from_arrays(cls, arrays: Arrays) -> "Review":
        """Restore a review, of any version.

        Raises:
            KeyError: An array is missing.
            ValueError: A reason is unknown.
        """
        frames, weak = len(arrays["frames"]), len(arrays["weak_index"])
        new = {"contours": ContourSight.none(frames).lines, "weak_point": np.full(weak, "")}
        new["unsure"] = np.zeros((frames, len(TURNED)), dtype=bool)
        plain = from_arrays(cls, {**new, **arrays})
        columns = [{**new, **arrays}[f"weak_{name}"].tolist() for name in WEAK]
        weak_frames = tuple(
            WeakFrame(index, Reason(reason), strength, None if marker < 0 else marker, point or None)
            for index, reason, strength, marker, point in zip(*columns, strict=True)
        )
        keypoints = ComparedKeypoints.from_arrays(arrays, frames)
        return cls(weak_frames=weak_frames, keypoints=keypoints, **plain)


def review(take: Take, reconstruction: Reconstruction, scene_frames: Array) -> Job[Review]:
    """Review a reconstruction; `scene_frames` (F,) are those of the clip's frames."""
    motion, tracks, model = reconstruction.motion, reconstruction.reading.tracks, reconstruction.model
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
        Sight(take.marker_segments, np.where(tracks.visible, tracks.quality, 0.0), misfit),
        contours,
        keypoints,
    )
    # Which turns are unsure, as in `Review`; none where nobody looked.
    unsure, solution = np.zeros((len(frame), len(TURNED)), dtype=bool), reconstruction.solution
    if motion.hands is not None:
        unsure[:, :-1] = motion.hands.sure < SURE
    if solution is not None and solution.problem.data.heads is not None:
        unsure[:, -1] = solution.problem.data.heads.std_rad > POINTS_STD_RAD
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
        speed=reconstruction.speed,
        confidence=believed,
        keyframe_indices=index,
        weak_frames=find_weak_frames(evidence, index),
        contours=contours.lines,
        keypoints=keypoints,
        unsure=unsure & there[:, None],
    )


def _predictions(model: RegionModel, pose: Pose, centroid: Array) -> Part[tuple[Array, Array]]:
    """Predicted outlines (F, M, K, 2) and the centroids' distances (F, M) from observed ones [px]."""
    outlines = np.full((*centroid.shape[:2], CORNERS, 2), np.nan)
    distance = np.full(centroid.shape[:2], np.nan)
    few = 100  # so few frames that a job can be canceled within some hundredths of a second
    for first in range(0, len(centroid), few):
        yield first / len(centroid)
        chunk = slice(first, first + few)
        frame = np.arange(len(centroid))[chunk]
        predicted = model.evaluate(pose[chunk], frame)
        seen = predicted.visible > NOISE.least_visible
        shape = ellipse_outline(predicted.centroid, predicted.second_moment)
        outlines[chunk] = np.where(seen[..., None, None], shape, np.nan)
        apart = np.linalg.norm(predicted.centroid - centroid[chunk], axis=-1)
        distance[chunk] = np.where(seen, apart, np.nan)
    return outlines, distance
