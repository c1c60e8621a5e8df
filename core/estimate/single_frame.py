"""One frame's posture from that frame's marker regions: assisted posing.

Maximum a posteriori about a belief in the posture, by the same terms and steps as the whole clip's estimate.
Five regions do not determine 34 degrees of freedom, and the image is ambiguous in depth; so several starts
descend side by side, each as if it were a frame of its own, and the most probable end is taken. What was
believed is among the candidates, so the markers never make the posture less probable than it was.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..footage.region_tracks import ExpectedRegions
from ..observation import depths
from ..observation.regions import RegionModel
from ..prior.frame_prior import FramePrior
from ..progress import run
from .clip_state import ClipState
from .keyframe_evidence import KeyframeEvidence, read_keyframes, uncalibrated
from .terms.ground import GroundTerm
from .terms.limits import LimitTerm
from .terms.quadratic import QuadraticBuilder
from .terms.regions import FEATURES, ObservedRegions, RegionNoise, RegionTerm, limb_widths
from .terms.term import NormalEquations, Term

TEMPERATURES = (64.0, 32.0, 16.0, 8.0, 4.0, 2.0, *(1.0 for _ in range(10)))
LARGEST_STEP = 0.4
"""No unknown of the posture moves further in one step [m, rad]."""
SETTLED = 2e-3
CALIBRATED_FROM = 5
"""So many keyframes tell more of where the markers sit than they err."""
EXPECTED_RADIUS_M = 0.9
"""How far a marker may lie from where it is believed to be."""
MISPLACED_WIDTHS = 1.5
"""A marker farther off than this many of its limb's half-widths is one the posture does not explain ..."""
MISPLACED_PX = 4.0
"""... unless it is nearer than this [px]."""


@dataclass(frozen=True, eq=False)
class FrameFit:
    """The posture found for one frame."""

    posture: Posture
    """A single posture."""
    residual_px: Array
    """(M,) distance of each marker's predicted centroid from the seen one [px]; NaN where it is not seen."""
    before_px: Array
    """(M,) the same for what was believed."""
    misplaced: tuple[int, ...]
    """Markers that the posture does not explain."""


def fit_frame(
    evidence: KeyframeEvidence,
    observed: ObservedRegions,
    belief: FramePrior,
    frame: int,
    noise: RegionNoise | None = None,
) -> FrameFit:
    """The most probable posture of one frame.

    Args:
        evidence: The markers' model, as calibrated on keyframes or of average proportions
            (`uncalibrated`).
        observed: The regions of this one frame, (1, M) of them; NaN where a marker is hidden.
        belief: What is believed before.
        frame: The frame's place in the clip, by which a moving camera knows its pose.
        noise: Noise of the regions' features.
    """
    descent = _Descent(evidence, observed, belief, frame, noise or RegionNoise())
    return descent.fit()


def calibrated(
    model: RegionModel, observed: ObservedRegions, keyframes: Posture, frame: IndexArray
) -> KeyframeEvidence:
    """What keyframes tell of the markers, where there are enough of them to tell.

    Args:
        model: The region model with average placements.
        observed: Regions seen at the K keyframes.
        keyframes: The K postures.
        frame: (K,) their poses of a moving camera.
    """
    if len(frame) < CALIBRATED_FROM:
        return uncalibrated(model)
    width_px = limb_widths(model, keyframes.translation, frame)
    return run(read_keyframes(model, RegionNoise(), observed, width_px, keyframes, frame))


def expected_in_frame(model: RegionModel, belief: FramePrior, frame: int) -> ExpectedRegions:
    """Where a belief puts each marker, (1, M), with a generous radius."""
    predicted = model.evaluate(model.body.pose(Posture.stack([belief.posture])), np.array([frame]))
    depth = max(float(model.camera.depth(belief.posture.translation, frame)), 0.1)
    radius = EXPECTED_RADIUS_M * model.camera.focal_px / depth
    return ExpectedRegions(predicted.centroid, np.full(predicted.visible.shape, radius))


class _Descent:
    """Several starts of one frame, side by side."""

    def __init__(
        self,
        evidence: KeyframeEvidence,
        observed: ObservedRegions,
        belief: FramePrior,
        frame: int,
        noise: RegionNoise,
    ) -> None:
        count = belief.starts.batch[0]
        self.model, self.observed = evidence.model, observed
        body, skeleton = evidence.model.body, belief.posture.skeleton
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
        self.bias_std = noise.bias_std(self.width_px).reshape(1, -1)
        repeated = observed[np.zeros(count, dtype=np.intp)]
        width = np.repeat(self.width_px, count, axis=0)
        self.regions = RegionTerm(self.model, repeated, noise, width, evidence.distrust, evidence.whole)
        builder = QuadraticBuilder(count, skeleton.dof_count + self.bias_std.shape[1])
        builder.add(slice(0, skeleton.dof_count), (1.0,), 1.0)
        builder.add(slice(skeleton.dof_count, None), (1.0,), self.bias_std)
        self.ground = _ground(body, belief)
        self.terms: list[Term] = [builder.term(), self.regions, LimitTerm()]
        if self.ground is not None:
            self.terms.append(self.ground)

    def fit(self) -> FrameFit:
        """Descend and choose."""
        start = replace(
            self.state,
            variation=np.zeros_like(self.state.variation),
        )
        best, least = start, self._costs(start)
        for temperature in TEMPERATURES:
            equations = NormalEquations(self.state.frames, self.state.unknowns.shape[1])
            for term in self.terms:
                term.add_to(equations, self.state, temperature)
            step = equations.matrix.factorise().solve(-equations.gradient)
            self.state, moved = self.state.stepped(step, LARGEST_STEP)
            if temperature > 1.0:
                continue
            costs = self._costs(self.state)
            better = costs < least
            best = replace(
                best,
                variation=np.where(better[:, None], self.state.variation, best.variation),
                bias=np.where(better[:, None], self.state.bias, best.bias),
            )
            least = np.minimum(costs, least)
            if moved < SETTLED:
                break
        chosen = int(np.argmin(least))
        posture = best.posture[chosen]
        residual = self._distances(posture)
        allowed = np.maximum(MISPLACED_WIDTHS * self.width_px[0], MISPLACED_PX)
        misplaced = np.flatnonzero(np.nan_to_num(residual) > allowed)
        return FrameFit(
            posture, residual, self._distances(self.believed[0]), tuple(int(m) for m in misplaced)
        )

    def _costs(self, state: ClipState) -> Array:
        """(S,) negative logarithm of the probability of each start's state, up to a constant."""
        excess = LimitTerm().excess(state)
        squared = (state.variation**2).sum(-1) + ((state.bias / self.bias_std) ** 2).sum(-1)
        costs = self.regions.misfit(state).sum(-1) + 0.5 * (squared + (excess**2).sum(-1))
        return np.asarray(costs if self.ground is None else costs + self.ground.cost(state))

    def _distances(self, posture: Posture) -> Array:
        """(M,) of the centroids [px]."""
        pose = self.model.body.pose(Posture.stack([posture]))
        predicted = self.model.evaluate(pose, self.state.frame[:1])
        return np.linalg.norm(predicted.centroid - self.observed.centroid, axis=-1)[0]


def _ground(body: Body, belief: FramePrior) -> GroundTerm | None:
    """Where the ankles are when a foot is on the ground."""
    if belief.grounded is None:
        return None
    ankles = tuple(i for i, name in enumerate(body.skeleton.point_names) if name.startswith("ankle"))
    points = body.points(body.pose(belief.grounded))
    return GroundTerm(ankles, float(points[:, list(ankles), 2].min()))


def _factor(model: RegionModel, belief: FramePrior, frame: int) -> Array:
    """A square root L (D, D) of the belief's covariance, in which the points keep near their depths.

    The image says little of depth, so the believed depths of the points count as seen (paper, eq. 9).
    """
    pose = model.body.pose(Posture.stack([belief.posture]))
    rows = depths.jacobian(model.body, model.camera, pose, np.array([frame]))[0] / belief.depth_std_m
    information = np.diag(belief.std**-2.0) + rows.T @ rows
    return np.linalg.cholesky(np.linalg.inv(information))
