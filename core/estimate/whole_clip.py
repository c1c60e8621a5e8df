"""Method `map`: the most probable postures of the whole clip at once (maximum a posteriori).

Gauss-Newton over all frames, which is the iterated Kalman smoother (Bell 1994, *The iterated Kalman
smoother as a Gauss-Newton method*). The unknown is the deviation δ from the prior: smooth over time, of
natural size, near zero at keyframes by as much as they are trusted; the regions, the prior's depths, feet
at rest and the hinges' ranges pull on it. Image noise is annealed, so that early steps do not lock on to
a wrong visibility.
"""

from collections.abc import Generator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Body
from ..body.posture import Posture
from ..footage.camera import Camera
from ..footage.tracks import RegionTracks
from ..observation import depths
from ..observation.regions import MarkerPlacement, RegionModel
from .calibration import KnownFrames, calibrate
from .clip_state import ClipState
from .posing_error import KeyframeInnovation, estimate_posing_scale, posing_covariance
from .terms.depths import DepthTerm
from .terms.limits import LimitTerm
from .terms.quadratic import QuadraticBuilder, QuadraticTerm
from .terms.regions import FEATURES, ObservedRegions, RegionNoise, RegionTerm, feature_rows, limb_widths
from .terms.stillness import StillnessTerm
from .terms.term import NormalEquations, Term

Array = NDArray[np.float64]

TEMPERATURES = (8.0, 4.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0)
LARGEST_STEP = 0.5
"""No unknown of the posture moves further in one step [m, rad]."""
SETTLED = 1e-3
FOOT_POINTS = ("ankle.L", "ankle.R")
REFERENCE_STEP_S = 1.0 / 30.0


@dataclass(frozen=True)
class MotionModel:
    """How the deviation from the prior behaves over time, in shares of its natural size."""

    acceleration_share: float = 0.25
    """Standard deviation of the second difference at 30 frames a second."""
    size_share: float = 4.0
    """Standard deviation of the deviation itself: weak, for what nothing else determines."""


@dataclass(frozen=True)
class WholeClipOptions:
    """What the whole-clip estimate believes."""

    motion: MotionModel = field(default_factory=MotionModel)
    regions: RegionNoise = field(default_factory=RegionNoise)


@dataclass(frozen=True, eq=False)
class WholeClipResult:
    """The estimate of F frames."""

    posture: Posture
    covariance: Array
    """(F, D, D) of the posture's own tangent."""
    posing_scale: float
    """Estimated size of the keyframes' error, relative to a person's usual one."""
    placements: tuple[MarkerPlacement, ...]
    residual_px: Array
    """(F, M) distance between the predicted and observed centroids [px]; NaN where not compared."""


def estimate_whole_clip(
    body: Body,
    camera: Camera,
    tracks: RegionTracks,
    segments: tuple[str, ...],
    prior: Posture,
    keyframe_indices: tuple[int, ...],
    options: WholeClipOptions | None = None,
) -> Generator[float, None, WholeClipResult]:
    """Estimate every frame's posture from all frames.

    Args:
        body: The actor's body.
        camera: The camera.
        tracks: Observed regions of F frames and M markers.
        segments: The segment each marker is bound to.
        prior: F postures that pass through the keyframes.
        keyframe_indices: Frames whose prior was posed.
        options: Noise and smoothness.

    Yields:
        The fraction done, from 0 to 1.

    Returns:
        Postures, their covariance and what was calibrated on the way.
    """
    options = options or WholeClipOptions()
    problem = _Problem(body, camera, tracks, segments, prior, keyframe_indices, options)
    state = problem.start()
    for i, temperature in enumerate(TEMPERATURES):
        equations = problem.equations(state, temperature)
        step = equations.matrix.factorise().solve(-equations.gradient)
        dofs = state.deviation.shape[1]
        step[:, :dofs] = np.clip(step[:, :dofs], -LARGEST_STEP, LARGEST_STEP)
        state = state.stepped(step)
        yield (i + 1) / (len(TEMPERATURES) + 1)
        if temperature == 1.0 and np.abs(step[:, :dofs]).max() < SETTLED:
            break
    return problem.result(state)


class _Problem:
    """Everything of one clip that stays the same from step to step."""

    def __init__(
        self,
        body: Body,
        camera: Camera,
        tracks: RegionTracks,
        segments: tuple[str, ...],
        prior: Posture,
        keyframe_indices: tuple[int, ...],
        options: WholeClipOptions,
    ) -> None:
        self.body, self.camera, self.prior, self.options = body, camera, prior, options
        self.frames = len(prior.translation)
        self.keyframes = np.array(keyframe_indices, dtype=np.intp)
        self.step_s = np.maximum(np.diff(tracks.time_s), 1e-3)
        self.observed = ObservedRegions.from_tracks(tracks)
        pose = body.pose(prior)
        frame = np.arange(self.frames)
        model = RegionModel(body, camera, tuple(MarkerPlacement(name) for name in segments))
        self.width_px = limb_widths(model, body.points(pose), frame)
        self.model = RegionModel(body, camera, self._calibrate(model))
        self.posing = posing_covariance(body, body.pose(prior[self.keyframes]))
        self.posing_scale = self._posing_scale()
        self.terms: list[Term] = [
            self._quadratic(),
            RegionTerm(self.model, self.observed, options.regions, self.width_px),
            DepthTerm(camera, depths.evaluate(body, camera, pose, frame)),
            LimitTerm(),
        ]
        points = tuple(body.skeleton.point_names.index(name) for name in FOOT_POINTS)
        self.terms.append(StillnessTerm(points, self.step_s))

    def start(self) -> ClipState:
        """The prior itself, without biases."""
        skeleton = self.body.skeleton
        markers = len(self.model.placements)
        return ClipState(
            self.body,
            self.prior,
            np.zeros((self.frames, skeleton.dof_count)),
            np.zeros((self.frames, markers * FEATURES)),
        )

    def equations(self, state: ClipState, temperature: float) -> NormalEquations:
        """The normal equations of all terms at a state."""
        equations = NormalEquations(self.frames, state.unknowns.shape[1])
        for term in self.terms:
            term.add_to(equations, state, temperature)
        return equations

    def result(self, state: ClipState) -> WholeClipResult:
        """The state with its uncertainty."""
        equations = self.equations(state, 1.0)
        blocks = equations.matrix.factorise().covariance_blocks()
        dofs = state.deviation.shape[1]
        covariance = state.chain @ blocks[:, :dofs, :dofs] @ np.swapaxes(state.chain, -1, -2)
        predicted = self.model.evaluate(state.pose, np.arange(self.frames))
        distance = np.linalg.norm(predicted.centroid - self.observed.centroid, axis=-1)
        compared = predicted.visible > self.options.regions.least_visible
        return WholeClipResult(
            state.posture,
            covariance,
            self.posing_scale,
            self.model.placements,
            np.asarray(np.where(compared, distance, np.nan), dtype=np.float64),
        )

    def _feature_variance(self, index: NDArray[np.intp]) -> Array:
        """(K, M, 5) variance of a region's features at a true posture, slow biases included [px²]."""
        noise, width = self.options.regions, self.width_px[index]
        return np.asarray(noise.pixel_std_px**2 + noise.surface_std(width) ** 2 + noise.bias_std(width) ** 2)

    def _known(self) -> KnownFrames:
        index = self.keyframes
        observed = self.observed
        picked = ObservedRegions(
            observed.centroid[index],
            observed.second_moment[index],
            observed.axes[index],
            observed.deviation[index],
            observed.quality[index],
        )
        std = np.sqrt(self._feature_variance(index))
        return KnownFrames(self.body.pose(self.prior[index]), index, picked, std)

    def _calibrate(self, model: RegionModel) -> tuple[MarkerPlacement, ...]:
        return calibrate(self.body, self.camera, model.placements, self._known())

    def _posing_scale(self) -> float:
        known = self._known()
        predicted = self.model.evaluate(known.pose, known.frame, jacobian=True)
        residual, jacobian = feature_rows(known.observed, predicted)
        assert jacobian is not None
        usable = np.isfinite(residual).all(-1) & (predicted.visible > 0.5) & (known.observed.quality > 0.5)
        innovations = [
            KeyframeInnovation(
                residual[k][usable[k]].ravel(),
                jacobian[k][usable[k]].reshape(-1, jacobian.shape[-1]),
                known.std_px[k][usable[k]].ravel() ** 2,
                self.posing[k],
            )
            for k in range(len(self.keyframes))
            if usable[k].any()
        ]
        return estimate_posing_scale(innovations)

    def _quadratic(self) -> QuadraticTerm:
        """Smoothness of the deviation, trust in keyframes, and the biases' slow drift."""
        skeleton, motion, noise = self.body.skeleton, self.options.motion, self.options.regions
        dofs = skeleton.dof_count
        markers = len(self.model.placements)
        builder = QuadraticBuilder(self.frames, dofs + markers * FEATURES)
        posture, bias = slice(0, dofs), slice(dofs, None)
        natural = skeleton.deviations
        pace = np.median(self.step_s) / REFERENCE_STEP_S if len(self.step_s) else 1.0
        builder.add(posture, (1.0, -2.0, 1.0), motion.acceleration_share * natural * pace**1.5)
        builder.add(posture, (1.0,), motion.size_share * natural)
        builder.add_blocks(self.keyframes, np.linalg.inv(self.posing * self.posing_scale**2))
        size = noise.bias_std(self.width_px).reshape(self.frames, -1)
        kept = np.exp(-self.step_s / noise.bias_time_s)[:, None] if len(self.step_s) else np.zeros((0, 1))
        builder.add(bias, (-kept, 1.0), size[1:] * np.sqrt(1.0 - kept**2))
        first = np.full_like(size, np.inf)
        first[0] = size[0]
        builder.add(bias, (1.0,), first)
        return builder.term()
