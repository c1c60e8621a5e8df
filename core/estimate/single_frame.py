"""One frame's posture from that frame's marker regions and keypoints: assisted posing.

Maximum a posteriori about a belief in the posture, by the same terms and steps as the whole clip's estimate.
Five regions or a dozen keypoints do not determine 34 degrees of freedom, and the image is ambiguous in depth;
so several starts descend side by side, each as if it were a frame of its own, and the most probable result is
taken. The believed posture is among the candidates, so the result is never less probable than it. Keypoints
are tried with left and right exchanged as well.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.posture import Posture
from ..footage.keypoints.body_points import mirror_images
from ..footage.region_tracks import ExpectedRegions
from ..observation import depths
from ..observation.regions import RegionModel
from ..prior.frame_prior import FramePrior
from ..progress import run
from .clip_state import ClipState
from .frame_descent import descend
from .frame_residuals import FrameResiduals, frame_residuals
from .keyframe_evidence import KeyframeEvidence, SeenAtKeyframes, read_keyframes, uncalibrated
from .keypoint_evidence import KeypointEvidence
from .terms.assembly import frame_terms
from .terms.keypoints import ObservedKeypoints
from .terms.regions import FEATURES, ObservedRegions, RegionNoise, limb_widths

CALIBRATED_FROM = 5
"""Fewest keyframes that calibrate: their placements are better than average ones."""
EXPECTED_RADIUS_M = 0.9
"""Largest distance of a marker from where it is believed to be."""
EXCHANGED_COST = 3.0
"""Cost of taking a detector's left for right: it is wrong in one frame of twenty."""


@dataclass(frozen=True, eq=False)
class FrameFit:
    """The posture found for one frame."""

    posture: Posture
    """A single posture."""
    residual_px: Array
    """(M,) distance between each marker's predicted and observed centroid [px]; NaN where it is hidden."""
    before_px: Array
    """(M,) the same for the believed posture."""
    misplaced: tuple[int, ...]
    """Indices of the markers that the posture does not explain."""
    keypoint_residual_px: Array = field(default_factory=lambda: np.zeros(0))
    """(N,) distance between each keypoint's predicted and observed place [px]; NaN where it is not seen."""
    misplaced_points: tuple[str, ...] = ()
    """Body points of the keypoints that the posture does not explain."""
    cost: float = 0.0
    """Negative logarithm of its probability, up to a constant of the frame."""


def fit_frame(
    evidence: KeyframeEvidence,
    observed: ObservedRegions,
    belief: FramePrior,
    frame: int,
    noise: RegionNoise | None = None,
    points: ObservedKeypoints | None = None,
) -> FrameFit:
    """The most probable posture of one frame.

    Args:
        evidence: The models of markers and keypoints, as calibrated on keyframes or of average proportions
            (`uncalibrated`).
        observed: The regions of this one frame, (1, M) of them; NaN where a marker is hidden.
        belief: Prior belief in the posture.
        frame: The frame's index in the clip, which a moving camera's pose depends on.
        noise: Noise of the regions' features.
        points: The keypoints of this one frame, (1, N); None for none.
    """
    noise = noise or RegionNoise()
    fit = _Descent(evidence, observed, belief, frame, noise, points).fit()
    if points is None or not points.seen.any():
        return fit
    mirrored = exchanged(points, evidence.keypoints.model.names, evidence.keypoints.sources)
    other = _Descent(evidence, observed, belief, frame, noise, mirrored).fit()
    return other if other.cost + EXCHANGED_COST < fit.cost else fit


def exchanged(
    points: ObservedKeypoints, names: tuple[str, ...], sources: tuple[str, ...]
) -> ObservedKeypoints:
    """The keypoints with left and right exchanged; a point without a mirror image stays."""
    partner = mirror_images(names, sources)
    return ObservedKeypoints(
        points.pixel[:, partner], points.confidence[:, partner], points.depth_m[:, partner]
    )


def calibrated(
    model: RegionModel,
    observed: ObservedRegions,
    keyframes: Posture,
    frame: IndexArray,
    keypoints: KeypointEvidence | None = None,
    points: ObservedKeypoints | None = None,
) -> KeyframeEvidence:
    """Evidence calibrated on keyframes, or uncalibrated where there are too few of them.

    Args:
        model: The region model with average placements.
        observed: Regions observed at the K keyframes.
        keyframes: The K postures.
        frame: (K,) their indices in the clip.
        keypoints: Usual evidence of the N keypoints; None for none.
        points: Those seen at the keyframes, (K, N).
    """
    if len(frame) < CALIBRATED_FROM:
        found = uncalibrated(model)
        return found if keypoints is None else replace(found, keypoints=keypoints)
    width_px = limb_widths(model, keyframes.translation, frame)
    at = SeenAtKeyframes(frame, keyframes, observed, width_px, keypoints, points)
    return run(read_keyframes(model, RegionNoise(), at))


def expected_in_frame(model: RegionModel, belief: FramePrior, frame: int) -> ExpectedRegions:
    """Each marker's place in the picture by a belief, (1, M), with a generous radius."""
    predicted = model.evaluate(model.body.pose(Posture.stack([belief.posture])), np.array([frame]))
    depth = max(float(model.camera.depth(belief.posture.translation, frame)), 0.1)
    radius = EXPECTED_RADIUS_M * model.camera.focal_px / depth
    return ExpectedRegions(predicted.centroid, np.full(predicted.visible.shape, radius))


class _Descent:
    """Gauss-Newton from several starts of one frame, side by side."""

    def __init__(
        self,
        evidence: KeyframeEvidence,
        observed: ObservedRegions,
        belief: FramePrior,
        frame: int,
        noise: RegionNoise,
        points: ObservedKeypoints | None,
    ) -> None:
        self.evidence, self.points = evidence, points
        count = belief.starts.batch[0]
        self.model, self.observed = evidence.model, observed
        body = evidence.model.body
        self.width_px = limb_widths(self.model, belief.posture.translation[None], np.array([frame]))
        self.believed = Posture.stack([belief.posture] * count)
        deviation = belief.starts.minus(self.believed)
        factor = _factor(evidence.model, belief, frame)
        self.state = ClipState(
            body,
            self.believed,
            np.full(count, frame, dtype=np.intp),
            factor,
            np.linalg.solve(factor, deviation.T).T,
            np.zeros((count, len(self.model.placements) * FEATURES)),
        )
        self.terms = frame_terms(evidence, observed, belief, noise, self.width_px, points)

    def fit(self) -> FrameFit:
        """Descend and choose."""
        best, least = descend(self.state, self.terms)
        chosen = int(np.argmin(least))
        posture = best.posture[chosen]
        found, before = (self._residuals(each) for each in (posture, self.believed[0]))
        return FrameFit(
            posture,
            found.marker_px,
            before.marker_px,
            found.markers,
            found.keypoint_px,
            found.points,
            float(least[chosen]),
        )

    def _residuals(self, posture: Posture) -> FrameResiduals:
        frame = int(self.state.frame[0])
        return frame_residuals(self.evidence, self.observed, self.points, posture, frame)


def _factor(model: RegionModel, belief: FramePrior, frame: int) -> Array:
    """A square root L (D, D) of the belief's covariance, with the points' depths as observations.

    The image tells little of depth, so the believed depths of the points count as observed (paper, eq. 9).
    """
    pose = model.body.pose(Posture.stack([belief.posture]))
    rows = depths.jacobian(model.body, model.camera, pose, np.array([frame]))[0] / belief.depth_std_m
    information = np.diag(belief.std**-2.0) + rows.T @ rows
    return np.linalg.cholesky(np.linalg.inv(information))
