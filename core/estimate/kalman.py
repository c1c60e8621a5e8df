"""The paper's filter, method `ekf`, with what the paper leaves open as options: noise and fuzzy sets."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.special import gammaincinv

from ..arrays import Array, BoolArray, IndexArray
from ..body import rotations
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..camera.camera import Camera
from ..markers.region_tracks import RegionTracks
from ..progress import Part, Preview
from ..terms.depths import DEPTH_STD_M, depths_jacobian, point_depths
from . import fuzzy
from .fuzzy import Memberships
from .line_ends import ANGLE, LOG_RATIO, LineEnds, X, Y, angle_weight, observed_characteristics, residual


@dataclass(frozen=True)
class FilterOptions:
    """Noise and sets of the paper's filter; docs/method.md says how each was settled.

    A *natural deviation* is how far a degree of freedom usually lies from a prior interpolated between
    keyframes (`Skeleton.deviations`).
    """

    centroid_std_px: float = 1.0  # extraction noise of a centroid [px]
    centroid_std_widths: float = 0.25  # of a centroid from the middle of its segment's line [widths]
    angle_std_rad: float = 0.1  # direction of a region as thin as a line; rounder ones have more [rad]
    log_ratio_std: float = 1.0  # of log S_λ, which sleeves and occlusion change more than posture does
    depth_std_m: float = DEPTH_STD_M  # noise of the a priori depths [m]
    initial_std: float = 0.5  # deviation of the first frame from the prior [natural deviations]
    near_width: float = 0.3  # half-width of the near rule's output set, a frame's step [natural deviations]
    far_width: float = 0.3  # half-width of the far rule's output set, a frame's step [natural deviations]
    gate_probability: float = 0.999  # share of right observations that pass; others count for less
    memberships: Memberships = field(default_factory=Memberships)  # the rules' input sets


class Update(NamedTuple):
    """Update of a state by measurements."""

    step: Array  # (D,) change of the mean
    covariance: Array  # (D, D) after the update, symmetric
    normalized_innovation_squared: float  # νᵀ S⁻¹ ν, χ² with as many degrees of freedom as rows


def update(covariance: Array, measurement_matrix: Array, innovation: Array) -> Update:
    """Kalman gain and update (paper, eqs. 14 to 17), for noise of covariance 1.

    The paper scales its observations with their standard deviations too, so R is the identity. Joseph's form
    keeps the covariance symmetric and positive where rounding would not.

    `covariance`: M (D, D), before the update; `measurement_matrix`: H (m, D), each row divided by its
    standard deviation; `innovation`: ν (m,), observed - predicted, likewise divided.
    """
    M, H = covariance, measurement_matrix
    MHt = M @ H.T
    factor = cho_factor(H @ MHt + np.eye(len(H)), lower=True)
    K = cho_solve(factor, MHt.T).T
    rest = np.eye(len(M)) - K @ H
    P = rest @ M @ rest.T + K @ K.T
    nis = float(innovation @ cho_solve(factor, innovation))
    return Update(K @ innovation, 0.5 * (P + P.T), nis)


def normalized_innovation_squared(covariance: Array, measurement_matrix: Array, innovation: Array) -> float:
    """νᵀ S⁻¹ ν of some rows alone, for gating; arguments as `update`."""
    S = measurement_matrix @ covariance @ measurement_matrix.T + np.eye(len(innovation))
    return float(innovation @ cho_solve(cho_factor(S, lower=True), innovation))


# --- The paper's filter, method `ekf`


PREVIEW_FRAMES = 12  # frames in one preview


@dataclass(frozen=True, eq=False)
class State:
    """A Gaussian over postures."""

    mean: Posture  # a single posture
    covariance: Array  # (D, D) of a tangent step at the mean [m², m rad, rad²]


@dataclass(frozen=True, eq=False)
class FilterResult:
    """The filter's estimate of F frames, with its own measures of consistency."""

    posture: Posture  # a batch of F postures
    covariance: Array  # (F, D, D) of a tangent step at each posture
    normalized_innovation_squared: Array  # νᵀ S⁻¹ ν, χ² with as many degrees of freedom as rows
    row_count: IndexArray  # (F,) number of rows that were used
    gated: BoolArray  # (F, M) whether a marker was past its gate and counted in part only


@dataclass(frozen=True, eq=False)
class Correction:
    """A state corrected by its observations."""

    state: State
    normalized_innovation_squared: float
    row_count: int
    gated: BoolArray  # (M,)


@dataclass(frozen=True, eq=False)
class FuzzyKalmanFilter:
    """The filter's two halves, for one clip of F frames; `filter_clip` runs them."""

    line_ends: LineEnds
    prior: Posture  # a batch of F a priori postures θ_p
    keyframes: Sequence[int]  # increasing indices of the keyframes, at least one
    options: FilterOptions = FilterOptions()

    @cached_property
    def distance(self) -> Array:
        """(F,) distance of each frame from its nearest keyframe, in half gaps."""
        return fuzzy.keyframe_distance(self.prior.batch[0], self.keyframes)

    @cached_property
    def prior_depths(self) -> Array:
        """(F, P) depths of the a priori postures' principal points [m]."""
        body, camera = self.line_ends.body, self.line_ends.camera
        return point_depths(body, camera, body.pose(self.prior), np.arange(self.prior.batch[0]))

    @cached_property
    def _gates(self) -> Array:
        """(5,) gate of the NIS for a marker's 0 to 4 rows."""
        half_rows = 0.5 * np.arange(1, 5)  # quantiles of χ² with 1 to 4 degrees of freedom
        return np.asarray([0.0, *(2.0 * gammaincinv(half_rows, self.options.gate_probability))])

    @property
    def _deviations(self) -> Array:
        return self.line_ends.body.skeleton.deviations

    def initial(self) -> State:
        """The first frame before its observations: the a priori posture."""
        return State(self.prior[0], np.diag((self.options.initial_std * self._deviations) ** 2))

    def step(self, mean: Posture, frame: int) -> tuple[Array, Array]:
        """Mean w̄ and variance, (D,) each, of the step from the frame before to `frame` (paper, section 5).

        Both rules are asked for the frame that the step leads to, so that a keyframe itself is wholly near.
        """
        options, prior = self.options, self.prior[frame]
        distance = self.distance[frame]
        near = fuzzy.OutputSet(
            prior.minus(mean),
            options.near_width * self._deviations,
            float(options.memberships.near(distance)),
        )
        far = fuzzy.OutputSet(
            prior.minus(self.prior[frame - 1]),
            options.far_width * self._deviations,
            float(options.memberships.far(distance)),
        )
        return fuzzy.aggregate(near, far)

    def predict(self, state: State, step: Array, variance: Array) -> State:
        """Move on by a step (D,) of variance (D,) (paper, eq. 13, and M = P + Q, the second eq. 17).

        The step is taken as known, as the paper prints it, although the near rule derives it from the
        estimate: the covariance does not shrink near a keyframe. Only its axes turn with the body.
        """
        dofs = self.line_ends.body.skeleton.ball_dofs
        turn = np.eye(len(step))
        turn[dofs[:, :, None], dofs[:, None, :]] = rotations.exponential(-step[dofs])
        return State(state.mean.plus(step), turn @ state.covariance @ turn.T + np.diag(variance))

    def correct(self, state: State, frame: int, observed: Array, quality: Array) -> Correction:
        """Correct a predicted state by its observations (paper, eqs. 12 and 14 to 18).

        `observed` (M, 4) as `observed_characteristics` gives them, NaN brings no row; `quality` (M,) in 0..1.
        """
        body, camera = self.line_ends.body, self.line_ends.camera
        pose = body.pose(state.mean)
        rows, innovation, gated = self._marker_rows(state, pose, frame, observed, quality)
        scale = 1.0 / self.options.depth_std_m
        rows.append(depths_jacobian(body, camera, pose, frame) * scale)
        innovation.append((self.prior_depths[frame] - point_depths(body, camera, pose, frame)) * scale)
        result = update(state.covariance, np.concatenate(rows), np.concatenate(innovation))
        # The covariance belongs to tangent steps at the old mean; at the new one they are measured anew.
        moved = state.mean.plus_jacobian(result.step)
        after = State(state.mean.plus(result.step), moved @ result.covariance @ moved.T)
        count = sum(len(part) for part in innovation)
        return Correction(after, result.normalized_innovation_squared, count, gated)

    def noise_std(self, predicted: Array, observed: Array, quality: Array, width_px: Array) -> Array:
        """Standard deviations (..., M, 4) of the characteristics: the square roots of R's diagonal.

        Characteristics (..., M, 4); `quality` (..., M) in 0..1, about the share of the region that is seen,
        divides the variance; `width_px` (..., M) of each segment.
        """
        options = self.options
        std = np.empty(np.broadcast_shapes(predicted.shape, observed.shape))
        std[..., [X, Y]] = np.hypot(options.centroid_std_px, options.centroid_std_widths * width_px)[
            ..., None
        ]
        # Both regions need a direction: a round one, observed or predicted, has none.
        weight = angle_weight(np.minimum(predicted[..., LOG_RATIO], observed[..., LOG_RATIO]))
        # 1e-3: a round region has no direction, and an infinite deviation is none.
        std[..., ANGLE] = options.angle_std_rad / np.maximum(weight, 1e-3)
        std[..., LOG_RATIO] = options.log_ratio_std
        # 0.05: below this a region's noise grows no further; its gate still holds
        return np.asarray(std / np.sqrt(np.maximum(quality, 0.05))[..., None])

    def _marker_rows(
        self, state: State, pose: Pose, frame: int, observed: Array, quality: Array
    ) -> tuple[list[Array], list[Array], BoolArray]:
        """Scaled rows and innovations of the visible markers; whether each is past its gate, (M,)."""
        predicted = self.line_ends.evaluate(pose, frame)
        std = self.noise_std(predicted, observed, quality, self.line_ends.width_px(pose, frame))
        scaled = residual(observed, predicted) / std
        matrix = self.line_ends.jacobian(pose, frame) / std[..., None]
        rows: list[Array] = []
        innovation: list[Array] = []
        gated = np.zeros(len(observed), dtype=bool)
        for marker, seen in enumerate(np.isfinite(scaled)):
            H, nu = matrix[marker, seen], scaled[marker, seen]
            if not len(nu):
                continue
            nis = normalized_innovation_squared(state.covariance, H, nu)
            gated[marker] = nis > self._gates[len(nu)]
            # Left out altogether, a marker could never recover an estimate that has lost it.
            weight = (self._gates[len(nu)] / nis) ** 0.5 if gated[marker] else 1.0
            rows.append(H * weight)
            innovation.append(nu * weight)
        return rows, innovation, gated


def filter_clip(
    body: Body,
    camera: Camera,
    tracks: RegionTracks,
    marker_segments: Sequence[str],
    prior: Posture,
    keyframes: Sequence[int],
    options: FilterOptions | None = None,
) -> Part[FilterResult]:
    """Estimate every frame of a clip by the paper's method.

    `prior`: F postures; `keyframes`: increasing indices, at least one.
    """
    frames = tracks.frame_count
    line_ends = LineEnds(body, camera, tuple(marker_segments))
    estimator = FuzzyKalmanFilter(line_ends, prior, keyframes, options or FilterOptions())
    observed = observed_characteristics(tracks)
    state = estimator.initial()
    done: list[Correction] = []
    for frame in range(frames):
        if frame > 0:
            state = estimator.predict(state, *estimator.step(state.mean, frame))
        done.append(estimator.correct(state, frame, observed[frame], tracks.quality[frame]))
        state = done[-1].state
        yield (frame + 1) / frames
        if (frame + 1) % PREVIEW_FRAMES == 0:
            yield Preview(
                frame + 1 - PREVIEW_FRAMES, Posture.stack([one.state.mean for one in done[-PREVIEW_FRAMES:]])
            )
    return FilterResult(
        posture=Posture.stack([one.state.mean for one in done]),
        covariance=np.stack([one.state.covariance for one in done]),
        normalized_innovation_squared=np.array([one.normalized_innovation_squared for one in done]),
        row_count=np.array([one.row_count for one in done], dtype=np.intp),
        gated=np.stack([one.gated for one in done]),
    )
