"""One frame's posture from its regions and keypoints, and what of them the posture does not explain."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.posture import Posture
from ..detect.keypoints import mirror_images
from ..markers.region_tracks import ExpectedRegions
from ..prior.frame_prior import FramePrior
from ..progress import run
from ..terms.depths import DEPTH_STD_M, depths_jacobian
from ..terms.keypoints import EXCHANGED_COST, ObservedKeypoints
from ..terms.region_model import RegionModel
from ..terms.regions import FEATURES, ObservedRegions, limb_widths
from ..terms.solver import descend
from ..terms.term import ClipState
from .assembly import frame_terms, grounded_terms
from .clip_problem import KeyframeEvidence, uncalibrated
from .keyframe_evidence import SeenAtKeyframes, read_keyframes
from .keypoint_evidence import KeypointEvidence


def is_misplaced_marker(off_px: Array, width_px: Array) -> BoolArray:
    """Whether markers lie off by more than one and a half half-widths of their limbs, and 4 px."""
    return np.asarray(np.nan_to_num(off_px) > np.maximum(1.5 * width_px, 4.0))


def is_misplaced_point(off_px: Array, scale: Array | float, confidence: Array) -> BoolArray:
    """Whether sure keypoints lie off by more than a limb's width and a detector's error, 12 cm, and 4 px.

    `scale`: pixels of a meter.
    """
    return np.asarray((np.nan_to_num(off_px) > np.maximum(0.12 * scale, 4.0)) & (confidence >= 0.5))


@dataclass(frozen=True, eq=False)
class FrameResiduals:
    """Distances in the picture, and what is misplaced."""

    marker_px: Array  # (M,) of the centroids [px]; NaN where a marker is hidden
    keypoint_px: Array  # (N,) of the keypoints [px]; NaN where one is not seen
    markers: tuple[int, ...]  # indices of the markers that the posture does not explain
    points: tuple[str, ...]  # body points of the keypoints that it does not explain


def frame_residuals(
    evidence: KeyframeEvidence,
    observed: ObservedRegions,
    points: ObservedKeypoints,
    posture: Posture,
    frame: int,
) -> FrameResiduals:
    """Compare a posture with what is seen of one frame.

    Regions (1, M) and keypoints (1, N) are those of this one frame.
    """
    model, index = evidence.model, np.array([frame])
    pose = model.body.pose(Posture.stack([posture]))
    off = np.linalg.norm(model.evaluate(pose, index).centroid - observed.centroid, axis=-1)[0]
    width = limb_widths(model, posture.translation[None], index)[0]
    markers = np.flatnonzero(is_misplaced_marker(off, width))
    own = evidence.keypoints.model
    depth = own.camera.depth(own.world(pose), index[:, None])[0]
    point_off = np.linalg.norm(own.pixels(pose, index) - points.pixel, axis=-1)[0]
    scale = own.camera.pixels_per_meter(depth)
    misplaced = np.flatnonzero(is_misplaced_point(point_off, scale, points.confidence[0]))
    names = tuple(dict.fromkeys(own.names[row] for row in misplaced))
    return FrameResiduals(off, point_off, tuple(map(int, markers)), names)


@dataclass(frozen=True, eq=False)
class FrameFit:
    """The posture found for one frame."""

    posture: Posture  # a single posture
    off: FrameResiduals  # from what is seen
    cost: float  # negative logarithm of its probability, up to a constant of the frame


def fit_frame(
    evidence: KeyframeEvidence,
    observed: ObservedRegions,
    belief: FramePrior,
    frame: int,
    points: ObservedKeypoints,
) -> FrameFit:
    """The most probable posture of one frame.

    Regions (1, M), NaN where hidden, and keypoints (1, N) are those of this one frame.
    """
    fit = _fitted(evidence, observed, belief, frame, points)
    if not points.seen.any():
        return fit
    mirrored = exchanged(points, evidence.keypoints)
    other = _fitted(evidence, observed, belief, frame, mirrored)
    return other if other.cost + EXCHANGED_COST < fit.cost else fit


def exchanged(points: ObservedKeypoints, evidence: KeypointEvidence) -> ObservedKeypoints:
    """The keypoints with left and right exchanged; a point without a mirror image stays."""
    partner = mirror_images(evidence.model.names, evidence.sources)
    return ObservedKeypoints(
        points.pixel[:, partner], points.confidence[:, partner], points.depth_m[:, partner]
    )


def calibrated(
    model: RegionModel,
    observed: ObservedRegions,
    keyframes: Posture,
    frame: IndexArray,
    keypoints: KeypointEvidence,
    points: ObservedKeypoints,
) -> KeyframeEvidence:
    """Evidence calibrated on keyframes, or uncalibrated where there are too few of them.

    Regions and keypoints are those seen at the K keyframes.
    """
    if len(frame) < 5:
        return uncalibrated(model, keypoints)
    width_px = limb_widths(model, keyframes.translation, frame)
    at = SeenAtKeyframes(frame, keyframes, observed, width_px, keypoints, points)
    return run(read_keyframes(model, at))


def expected_in_frame(model: RegionModel, belief: FramePrior, frame: int) -> ExpectedRegions:
    """Each marker's place in the picture by a belief, (1, M), with a generous radius."""
    predicted = model.evaluate(model.body.pose(Posture.stack([belief.posture])), np.array([frame]))
    # 0.9: largest distance of a marker from where it is believed to be
    radius = 0.9 * model.camera.pixels_per_meter(model.camera.depth(belief.posture.translation, frame))
    return ExpectedRegions(predicted.centroid, np.full(predicted.visible.shape, radius))


def _fitted(
    evidence: KeyframeEvidence,
    observed: ObservedRegions,
    belief: FramePrior,
    frame: int,
    points: ObservedKeypoints,
) -> FrameFit:
    model, count = evidence.model, belief.starts.batch[0]
    believed = Posture.stack([belief.posture] * count)
    factor = _factor(model, belief, frame)
    variation = np.linalg.solve(factor, belief.starts.minus(believed).T).T
    bias = np.zeros((count, len(model.placements) * FEATURES))
    frames = np.full(count, frame, dtype=np.intp)
    state = ClipState(model.body, believed, frames, factor, variation, bias)
    width_px = limb_widths(model, belief.posture.translation[None], np.array([frame]))
    standing = grounded_terms(model.body, belief.grounded)
    best, least = descend(state, frame_terms(evidence, observed, count, width_px, points, standing))
    chosen = int(np.argmin(least))
    posture, cost = best.posture[chosen], float(least[chosen])
    return FrameFit(posture, frame_residuals(evidence, observed, points, posture, frame), cost)


def _factor(model: RegionModel, belief: FramePrior, frame: int) -> Array:
    """A square root L (D, D) of the belief's covariance, with the points' depths as observations.

    The image tells little of depth, so the believed depths of the points count as observed (paper, eq. 9).
    """
    pose = model.body.pose(Posture.stack([belief.posture]))
    rows = depths_jacobian(model.body, model.camera, pose, np.array([frame]))[0] / DEPTH_STD_M
    information = np.diag(belief.std**-2.0) + rows.T @ rows
    return np.linalg.cholesky(np.linalg.inv(information))
