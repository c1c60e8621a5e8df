"""The paper's filter, and its update by measurements."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from keymark.core.body import rotations
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.body.skeleton import Joint, JointKind, PrincipalPoint, Segment, Skeleton
from keymark.core.camera.camera import Camera
from keymark.core.estimate.fuzzy import Memberships
from keymark.core.estimate.kalman import (
    FilterOptions,
    FilterResult,
    FuzzyKalmanFilter,
    State,
    filter_clip,
    normalized_innovation_squared,
    update,
)
from keymark.core.estimate.line_ends import LineEnds, observed_characteristics
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.progress import run
from keymark.core.terms.depths import point_depths

See = Callable[..., RegionTracks]
ALWAYS_FAR = Memberships(near_ends=1e-9, far_starts=0.0, far_full=1e-9)
STIFF = 1e-9
"""Natural deviation of a rotation that in effect cannot turn [rad]."""


def run_filter(
    line_ends: LineEnds, tracks: RegionTracks, prior: Posture, keyframes: list[int], options: FilterOptions
) -> FilterResult:
    return run(
        filter_clip(line_ends.body, line_ends.camera, tracks, line_ends.segments, prior, keyframes, options)
    )


def drifting(line_ends: LineEnds, frames: int, seed: int = 0) -> tuple[Posture, Posture]:
    """A smooth a priori motion (F), and a true one that leaves it slowly."""
    rng = np.random.default_rng(seed)
    deviations = line_ends.body.skeleton.deviations
    start = Posture.rest(line_ends.body.skeleton).plus(rng.normal(0.0, 0.2, len(deviations)))
    time = np.linspace(0.0, 1.0, frames)[:, None]
    prior = start.plus(time * rng.normal(0.0, 0.3, len(deviations)))
    return prior, prior.plus(np.sin(np.pi * time) * deviations * rng.normal(0.0, 0.7, len(deviations)))


def linear_problem() -> tuple[Body, Camera, Posture, np.ndarray]:
    """One rigid joint that in effect only shifts, seen by a camera that turns: depths are linear in it."""
    names = tuple(f"location_{axis}" for axis in "xyz") + tuple(f"rotation_{axis}" for axis in "xyz")
    deviations = (0.2, 0.3, 0.25, STIFF, STIFF, STIFF)
    root = Joint("root", -1, JointKind.FREE, {}, components=names, deviations=deviations)
    points = (PrincipalPoint("a", 0, {}), PrincipalPoint("b", 0, {"trunk": (0.3, 0.1, 1.0)}))
    stick = Segment("head", 0, {}, {"trunk": (0.0, 0.0, 1.0)}, None)
    body = Body(Actor.from_stature(1.7), Skeleton((root,), (stick,), points))
    frames, rng = 12, np.random.default_rng(7)
    turned = Posture.rest(body.skeleton, (frames,)).plus(
        np.concatenate([np.zeros((frames, 3)), rng.normal(0.0, 1.0, (frames, 3))], axis=1)
    )
    matrix = np.tile(np.eye(4), (frames, 1, 1))
    matrix[:, :3, :3] = turned.rotations[:, 0]
    matrix[:, :3, 3] = rng.normal(0.0, 2.0, (frames, 3))
    prior = Posture.rest(body.skeleton, (frames,)).plus(
        np.concatenate([rng.normal(0.0, 0.2, (frames, 3)), np.zeros((frames, 3))], axis=1)
    )
    return body, Camera(40.0, 36.0, (320, 240), matrix), prior, -matrix[:, :3, 2]


def shown_depths(problem: FuzzyKalmanFilter, truth: np.ndarray, axes: np.ndarray) -> FuzzyKalmanFilter:
    """The same filter, told depths that differ from the prior's as a shift (F, 3) would make them."""
    told = problem.prior_depths + np.einsum("fi,fi->f", axes, truth)[:, None]
    problem.__dict__["prior_depths"] = told
    return problem


def test_on_a_linear_problem_the_filter_is_the_kalman_filter_and_least_squares() -> None:
    body, camera, prior, axes = linear_problem()
    frames, size = len(axes), 3
    options = FilterOptions(memberships=ALWAYS_FAR, initial_std=1.0, far_width=0.4)
    told = np.random.default_rng(8).normal(0.0, 0.3, (frames, 3))
    problem = shown_depths(
        FuzzyKalmanFilter(LineEnds(body, camera, ("head",)), prior, [0], options), told, axes
    )
    state, hidden = problem.initial(), np.full((1, 4), np.nan)
    for frame in range(frames):
        if frame:
            state = problem.predict(state, *problem.step(state.mean, frame))
        state = problem.correct(state, frame, hidden, np.zeros(1)).state

    deviation = body.skeleton.deviations[:size]
    rows, target = [], []

    def add(blocks: dict[int, np.ndarray], goal: np.ndarray, std: np.ndarray) -> None:
        row = np.zeros((len(goal), frames * size))
        for frame, block in blocks.items():
            row[:, frame * size : (frame + 1) * size] = block
        rows.append(row / std[:, None])
        target.append(goal / std)

    # Unknowns are deviations from the prior, which the far rule keeps; a triangle's variance is width²/6.
    add({0: np.eye(size)}, np.zeros(size), deviation)
    for frame in range(1, frames):
        add({frame: np.eye(size), frame - 1: -np.eye(size)}, np.zeros(size), 0.4 * deviation / 6.0**0.5)
    for frame in range(frames):
        seen = np.tile(axes[frame], (2, 1))
        add({frame: seen}, seen @ told[frame], np.full(2, options.depth_std_m))
    A, b = np.concatenate(rows), np.concatenate(target)
    solution = np.linalg.solve(A.T @ A, A.T @ b)[-size:]
    covariance = np.linalg.solve(A.T @ A, np.eye(A.shape[1]))[-size:, -size:]
    np.testing.assert_allclose(state.mean.minus(prior[-1])[:size], solution, atol=1e-7)
    np.testing.assert_allclose(state.covariance[:size, :size], covariance, rtol=1e-6)


SHARP = FilterOptions(
    centroid_std_px=0.02,
    centroid_std_widths=1e-4,
    angle_std_rad=2e-4,
    log_ratio_std=5e-4,
    depth_std_m=3.0,
    initial_std=1.0,
    gate_probability=1.0 - 1e-15,
    memberships=ALWAYS_FAR,
)
"""Observations without noise, and depths that say next to nothing."""


@pytest.mark.parametrize("seed", range(4))
def test_a_posture_that_the_picture_shows_is_recovered(line_ends: LineEnds, see: See, seed: int) -> None:
    rng = np.random.default_rng(seed)
    prior = Posture.rest(line_ends.body.skeleton, (25,)).plus(rng.normal(0.0, 0.15, 34))
    deviations = prior.skeleton.deviations
    H = line_ends.jacobian(line_ends.body.pose(prior[0])) * deviations
    strength, shown = np.linalg.svd((H / [[[1.0], [1.0], [0.01], [0.01]]]).reshape(20, 34))[1:]
    shown = shown[:20][strength > 0.1 * strength[0]]
    assert len(shown) >= 8
    truth = prior.plus(deviations * (rng.normal(0.0, 0.01, len(shown)) @ shown))
    result = run_filter(line_ends, see(truth), prior, [0], SHARP)
    before = np.abs(truth[-1].minus(prior[-1]) / deviations)
    after = np.abs(truth[-1].minus(result.posture[-1]) / deviations)
    assert after.max() < 0.1 * before.max()


def test_a_keyframe_is_predicted_from_itself(line_ends: LineEnds, see: See) -> None:
    prior, truth = drifting(line_ends, 9)
    estimator = FuzzyKalmanFilter(line_ends, prior, [0, 4, 8])
    state = estimator.predict(State(truth[3], np.eye(34)), *estimator.step(truth[3], 4))
    np.testing.assert_allclose(state.mean.minus(prior[4]), 0.0, atol=1e-12)
    midway, _ = estimator.step(truth[1], 2)
    np.testing.assert_allclose(midway, prior[2].minus(prior[1]), atol=1e-12)


def test_prediction_adds_the_process_noise_and_turns_the_axes(line_ends: LineEnds) -> None:
    prior, truth = drifting(line_ends, 9)
    estimator = FuzzyKalmanFilter(line_ends, prior, [0, 8])
    root = np.random.default_rng(1).normal(size=(34, 34))
    before = State(truth[3], root @ root.T)
    step, variance = estimator.step(truth[3], 4)
    after = estimator.predict(before, step, variance)
    assert np.trace(after.covariance) == pytest.approx(np.trace(before.covariance) + variance.sum())
    dofs = prior.skeleton.ball_dofs[2]
    turn = (before.mean.rotations[2].T @ after.mean.rotations[2]).T
    old = before.covariance[np.ix_(dofs, dofs)]
    np.testing.assert_allclose(
        after.covariance[np.ix_(dofs, dofs)], turn @ old @ turn.T + np.diag(variance[dofs]), rtol=1e-9
    )
    # What the covariance is of: an error turned in the parent's axes is, after the step, the turned error.
    error = 1e-6 * root[0, :3]
    world = before.mean.rotations[2] @ rotations.exponential(error) @ before.mean.rotations[2].T
    found = rotations.logarithm(after.mean.rotations[2].T @ world @ after.mean.rotations[2])
    np.testing.assert_allclose(found, turn @ error, rtol=1e-5, atol=1e-12)


def test_hidden_markers_bring_no_rows_and_more_uncertainty(line_ends: LineEnds, see: See) -> None:
    prior, truth = drifting(line_ends, 15)
    visible = np.ones((15, 5), dtype=bool)
    visible[5:10, 1] = False
    visible[12] = False
    full = run_filter(line_ends, see(truth), prior, [0, 14], FilterOptions())
    partial = run_filter(line_ends, see(truth, visible), prior, [0, 14], FilterOptions())
    np.testing.assert_array_equal(full.row_count, 33)
    np.testing.assert_array_equal(partial.row_count[5:10], 29)
    assert partial.row_count[12] == 13
    assert not partial.gated.any()
    shoulder = [i for i, name in enumerate(prior.skeleton.dof_names) if name.startswith("shoulder.L")]
    for frame in range(5, 10):
        hidden, seen = partial.covariance[frame], full.covariance[frame]
        assert np.trace(hidden[np.ix_(shoulder, shoulder)]) > np.trace(seen[np.ix_(shoulder, shoulder)])
    assert np.isfinite(partial.posture.to_vector()).all()


def test_a_doubtful_region_counts_for_less(line_ends: LineEnds, see: See) -> None:
    prior, truth = drifting(line_ends, 15)
    estimator = FuzzyKalmanFilter(line_ends, prior, [0, 14])
    observed = observed_characteristics(see(truth))[7]
    state = State(prior[7], estimator.initial().covariance)
    moved = [
        np.linalg.norm(estimator.correct(state, 7, observed, np.full(5, quality)).state.mean.minus(prior[7]))
        for quality in (1.0, 0.2)
    ]
    assert moved[1] < 0.8 * moved[0]


def test_a_region_that_cannot_be_the_marker_pulls_little(line_ends: LineEnds, see: See) -> None:
    prior, truth = drifting(line_ends, 15)
    tracks = see(truth)
    centroid = tracks.centroid.copy()
    centroid[8, 3] += [90.0, -45.0]
    wrong = replace(tracks, centroid=centroid)
    right = run_filter(line_ends, tracks, prior, [0, 14], FilterOptions())
    gated = run_filter(line_ends, wrong, prior, [0, 14], FilterOptions())
    believed = run_filter(line_ends, wrong, prior, [0, 14], FilterOptions(gate_probability=1.0 - 1e-16))
    assert gated.gated[8].tolist() == [False, False, False, True, False]
    assert not right.gated.any()
    moved = [np.linalg.norm(one.posture[8].minus(right.posture[8])) for one in (gated, believed)]
    assert moved[0] < 0.6 * moved[1]


def test_a_lost_limb_is_called_back(line_ends: LineEnds, see: See) -> None:
    prior, truth = drifting(line_ends, 20)
    lost = np.zeros(34)
    lost[prior.skeleton.dof_names.index("shoulder.L.rotation_y")] = 1.2
    tracks = see(truth[:1].plus(np.broadcast_to(lost, (20, 34))))
    still = prior[:1].plus(np.zeros((20, 34)))
    result = run_filter(line_ends, tracks, still, [0], FilterOptions(memberships=ALWAYS_FAR))
    distance = np.linalg.norm(
        line_ends.evaluate(line_ends.body.pose(result.posture))[:, 1, :2] - tracks.centroid[:, 1], axis=-1
    )
    assert result.gated[0, 1]
    assert not result.gated[-1].any()
    assert distance[-1] < 2.0 < 30.0 < distance[0]


def test_the_a_priori_depths_are_those_of_the_prior(line_ends: LineEnds) -> None:
    prior, _ = drifting(line_ends, 5)
    estimator = FuzzyKalmanFilter(line_ends, prior, [0, 4])
    expected = point_depths(line_ends.body, line_ends.camera, line_ends.body.pose(prior[2]), 2)
    np.testing.assert_allclose(estimator.prior_depths[2], expected, rtol=1e-12)


ILL_CONDITIONED = (
    np.diag([1e8, 1e-10, 1.0]),
    np.array([[1e6, 1e6 - 1e-4, 0.0], [1e6 - 1e-4, 1e6, 0.0], [0.0, 0.0, 1e-9]]),
    1e4 * np.ones((3, 3)) + np.diag([1e-9, 2e-9, 3e-9]),
)
"""Condition numbers of 1e18, 1e15 and 1e13: a plain (I - K H) M leaves them indefinite or lopsided."""


def test_the_gain_agrees_with_the_information_form() -> None:
    rng = np.random.default_rng(0)
    root, H, innovation = rng.normal(size=(6, 6)), rng.normal(size=(9, 6)), rng.normal(size=9)
    M = root @ root.T + np.eye(6)
    result = update(M, H, innovation)
    information = np.linalg.solve(M, np.eye(6)) + H.T @ H
    np.testing.assert_allclose(result.covariance @ information, np.eye(6), atol=1e-9)
    np.testing.assert_allclose(result.step, np.linalg.solve(information, H.T @ innovation), rtol=1e-9)
    S = H @ M @ H.T + np.eye(9)
    assert result.normalized_innovation_squared == pytest.approx(innovation @ np.linalg.solve(S, innovation))
    assert normalized_innovation_squared(M, H, innovation) == pytest.approx(
        result.normalized_innovation_squared
    )


@pytest.mark.parametrize("M", ILL_CONDITIONED)
def test_ill_conditioned_covariances_stay_symmetric_and_positive(M: np.ndarray) -> None:
    rng = np.random.default_rng(1)
    P = M
    for _ in range(200):
        H = rng.normal(size=(4, 3)) * np.array([[1e4], [1.0], [1e-3], [1e2]])
        before = P
        P = update(P, H, rng.normal(size=4)).covariance + 1e-12 * np.eye(3)
        np.testing.assert_array_equal(P, P.T)
        np.linalg.cholesky(P)
        assert np.trace(P) <= np.trace(before) * (1.0 + 1e-9) + 1e-11
