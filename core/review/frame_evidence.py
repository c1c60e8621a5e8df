"""Evidence of each frame of a motion: markers, keypoints, and contours, which judge where no marker does."""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.kinematics import extremity_names
from ..estimate.keypoint_evidence import KeypointEvidence
from ..estimate.keypoint_fit import keypoint_fit
from ..estimate.reconstruct import Reconstruction
from ..take.evidence import UsedEvidence, UsedKeypoints
from ..terms.contours import SHARES, SIDES, SURFACE_SHARE
from ..terms.keypoints import ObservedKeypoints
from .compared_keypoints import ComparedKeypoints
from .weak_frames import FrameEvidence


@dataclass(frozen=True, eq=False)
class Sight:
    """Markers or contours of segments in F frames."""

    segments: tuple[str, ...]  # (N,) the segment of each
    quality: Array  # (F, N) of its regions, or the share of its contour near an edge of what usually is
    misfit: Array  # (F, N) as in `confidence`; NaN where not compared


@dataclass(frozen=True, eq=False)
class ContourSight(Sight):
    """The contours of the O parts of the body in F frames, without hands and feet."""

    lines: Array  # (F, L, S, 2) contour lines of all parts as the motion predicts them [px]

    @classmethod
    def none(cls, frames: int) -> "ContourSight":
        """No contour at all, O = 0."""
        return cls((), np.zeros((frames, 0)), np.zeros((frames, 0)), np.zeros((frames, 0, len(SHARES), 2)))


def contour_sight(reconstruction: Reconstruction) -> Generator[float, None, ContourSight]:
    """Edges near a motion's contours; none where markers judge the motion, or no contour was followed."""
    motion, solution = reconstruction.motion, reconstruction.solution
    frame = np.arange(len(motion.time_s))
    if reconstruction.reading.tracks.names or solution is None or solution.contours is None:
        return ContourSight.none(len(frame))
    found, _ = yield from solution.contours.measure(motion.posture, frame)
    model = found.model
    predicted = model.evaluate(motion.body.pose(motion.posture), frame)
    distance = np.sum(found.normal * (predicted.pixel - found.edge), axis=-1)
    squared = distance**2 / (found.variance + (SURFACE_SHARE * predicted.half_width) ** 2)
    loose = extremity_names(motion.body.skeleton)  # no posture turns hands and feet
    parts = [part for part in model.parts.segments if part not in loose]
    index = [model.parts.segments.index(part) for part in parts]
    own = (model.part_of[:, None] == np.array(index)).astype(np.float64)  # (N, O)
    seen = np.isfinite(squared)
    number = seen @ own
    misfit = np.where(seen, squared, 0.0) @ own / np.maximum(number, 1.0)
    share = number / own.sum(axis=0)
    usual = np.median(share, axis=0)
    # Nobody misses a part that seldom shows, as the trunk's contour behind the arms.
    quality = np.where(usual < 0.25, 1.0, np.clip(share / np.maximum(usual, 0.25), 0.0, 1.0))
    along = predicted.pixel.reshape(len(frame), -1, len(SHARES), len(SIDES), 2)
    lines = np.swapaxes(along, 2, 3).reshape(len(frame), -1, len(SHARES), 2)
    there = motion.there
    lines = np.where(there[:, None, None, None], lines, np.nan)
    misfit = np.where(there[:, None] & (number > 0.0), misfit, np.nan)
    return ContourSight(tuple(parts), quality, misfit, lines)


ENDS: dict[str, tuple[str, ...]] = {
    f"{segment}.{side}": tuple(f"{end}.{side}" for end in ends)
    for segment, *ends in (
        *(("upper_arm", "shoulder", "elbow"), ("forearm", "elbow", "wrist"), ("hand", "wrist")),
        *(("thigh", "hip", "knee"), ("shin", "knee", "ankle"), ("foot", "ankle")),
    )
    for side in "LR"
} | {
    "trunk": ("shoulder.L", "shoulder.R", "hip.L", "hip.R"),
    "chest": ("shoulder.L", "shoulder.R"),
    "pelvis": ("hip.L", "hip.R"),
    "head": ("head",),
}
"""Body points that lie at the ends of a segment."""


def believed_misfits(markers: Array, contours: ContourSight, keypoints: ComparedKeypoints) -> Array:
    """Misfits (F, M + O + K) of markers, contours, and the body points whose keypoints are believed."""
    believed = np.where(keypoints.thrown_out, np.nan, keypoints.misfit)
    return np.concatenate([markers, contours.misfit, keypoints.by_part(believed)], axis=1)


def frame_evidence(
    squared_error: Array,
    confidence: Array,
    speed: Array,
    markers: Sight,
    contours: ContourSight,
    keypoints: ComparedKeypoints,
) -> FrameEvidence:
    """Evidence of F frames, of M markers, O contours and K body points."""
    segments = (*markers.segments, *contours.segments)
    covered = np.concatenate([markers.quality, contours.quality], axis=1)
    points, by_point = keypoints.parts(), keypoints.quality()
    shown, seen = covered.copy(), by_point.copy()
    for column, segment in enumerate(segments):
        ends = ENDS.get(segment, ())
        if ends and set(ends) <= set(points):
            both = by_point[:, [points.index(end) for end in ends]].min(axis=1)
            shown[:, column] = np.maximum(shown[:, column], both)
    for column, point in enumerate(points):
        covering = [index for index, segment in enumerate(segments) if point in ENDS.get(segment, ())]
        if covering:
            seen[:, column] = np.maximum(seen[:, column], covered[:, covering].max(axis=1))
    return FrameEvidence(
        squared_error,
        confidence,
        np.concatenate([shown, seen], axis=1),
        np.concatenate([markers.misfit, contours.misfit, keypoints.by_part(keypoints.misfit)], axis=1),
        speed,
        (*contours.segments, *points),
    )


def compare_keypoints(reconstruction: Reconstruction) -> ComparedKeypoints:
    """The performer's keypoints beside the motion's, also for a method that does not follow them."""
    keypoints, motion, fit = reconstruction.keypoints, reconstruction.motion, reconstruction.keypoint_fit
    if not keypoints.names:
        return ComparedKeypoints.none(len(motion.time_s))
    if fit is None:
        camera = reconstruction.model.camera
        evidence = KeypointEvidence.usual(motion.body, camera, keypoints.names, keypoints.sources)
        none = np.zeros(keypoints.score.shape, dtype=bool)
        fit = keypoint_fit(evidence, keypoints, ObservedKeypoints.of(keypoints), none, motion.posture)
    return ComparedKeypoints(
        names=fit.keypoints.names,
        sources=fit.keypoints.sources,
        seen=fit.keypoints.pixel,
        predicted=np.where(motion.there[:, None, None], fit.predicted_px, np.nan),
        confidence=ObservedKeypoints.of(fit.keypoints).confidence,
        distance_px=fit.residual_px,
        expected_px=fit.std_px,
        thrown_out=fit.thrown_out,
        swapped=fit.swapped,
    )


def used_evidence(reconstruction: Reconstruction) -> UsedEvidence:
    """What a motion was held against: all that a take has, but with the paper's filter its markers alone."""
    method, markers = reconstruction.motion.method, reconstruction.reading.tracks.names
    solution = reconstruction.solution
    if method != "map" or solution is None:
        return UsedEvidence(markers if method == "ekf" else ())
    trusted = solution.evidence.keypoints.trust > 0.0
    hints = bool(np.isfinite(solution.problem.data.points.depth_m[:, trusted]).any())
    compared = compare_keypoints(reconstruction)
    seen = np.isfinite(compared.seen).all(axis=-1)
    used = []
    for source in dict.fromkeys(compared.sources):
        own = [index for index, other in enumerate(compared.sources) if other == source]
        count = int(seen[:, own].sum())
        doubted, swapped = (
            float((seen & flags)[:, own].sum()) / max(count, 1)
            for flags in (compared.thrown_out, compared.swapped)
        )
        names = tuple(dict.fromkeys(compared.names[index] for index in own))
        used.append(UsedKeypoints(source, names, 1.0 - doubted if count else 0.0, swapped))
    return UsedEvidence(markers, tuple(used), hints, solution.contours is not None)
