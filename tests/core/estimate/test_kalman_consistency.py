"""Whether the filter's covariances tell the truth."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from _consistency import chi_square_average, coverage, mean_interval, normalized_squared
from keymark.core.body.posture import Posture
from keymark.core.estimate.kalman import FilterOptions, FuzzyKalmanFilter
from keymark.core.estimate.reconstruct import reconstruct
from keymark.core.evidence import keypoints as depths
from keymark.core.evidence.line_ends import LineEnds
from keymark.core.progress import run
from keymark.core.take.take_file import read_take


def test_normalized_squares_by_hand() -> None:
    assert normalized_squared([4.0, 3.0], np.diag([4.0, 9.0])) == pytest.approx(5.0)
    assert normalized_squared([1.0, 1.0], [[2.0, 1.0], [1.0, 2.0]]) == pytest.approx(2.0 / 3.0)


def test_normalized_squares_of_a_batch() -> None:
    errors = np.arange(12.0).reshape(2, 3, 2)
    batch = normalized_squared(errors, np.broadcast_to(np.diag([1.0, 4.0]), (2, 3, 2, 2)))
    np.testing.assert_allclose(batch, errors[..., 0] ** 2 + errors[..., 1] ** 2 / 4.0)


def test_a_covariance_that_is_none_is_an_error() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        normalized_squared([1.0, 1.0], [[1.0, 2.0], [2.0, 1.0]])


def test_chi_square_bounds_are_the_tables() -> None:
    interval = chi_square_average([10.0], 10)
    assert interval.average == 10.0
    assert interval.low == pytest.approx(3.247, abs=5e-4)
    assert interval.high == pytest.approx(20.483, abs=5e-4)


def test_the_average_tells_honest_from_overconfident_and_timid() -> None:
    errors = np.random.default_rng(3).normal(size=(50, 6))
    for scale, verdict in ((1.0, "honest"), (0.5, "overconfident"), (2.0, "timid")):
        values = normalized_squared(errors, np.eye(6) * scale)
        average, low, high = chi_square_average(values, 6)
        found = "overconfident" if average > high else "timid" if average < low else "honest"
        assert found == verdict


def test_degrees_of_freedom_may_differ_between_frames() -> None:
    interval = chi_square_average([2.0, 4.0, 6.0], [2, 4, 6])
    assert interval.low < 4.0 < interval.high
    assert interval == chi_square_average([4.0, 4.0, 4.0], 4)


def test_coverage_by_hand() -> None:
    error, sigma = [1.0, -1.9, 2.0, 1.0, 9.0, np.nan], [1.0, 1.0, 1.0, 1.0, np.nan, 1.0]
    assert coverage(error, sigma) == 0.75
    assert np.isnan(coverage([np.nan], [1.0]))


def test_the_interval_of_a_mean_is_students() -> None:
    interval = mean_interval([1.0, 2.0, 3.0])
    assert interval.average == pytest.approx(2.0)
    assert interval.high - 2.0 == pytest.approx(4.303 / np.sqrt(3.0), abs=1e-3)
    assert 2.0 - interval.low == pytest.approx(interval.high - 2.0)
    with pytest.raises(ValueError, match="2 runs"):
        mean_interval([1.0])


RUNS, FRAMES = 12, 14
KEYFRAMES = (0, 5, 9, 13)
OPTIONS = FilterOptions(
    depth_std_m=0.03, initial_std=0.3, near_width=0.2, far_width=0.3, gate_probability=1.0 - 1e-12
)


def moving_prior(line_ends: LineEnds) -> Posture:
    """An a priori motion of every degree of freedom."""
    rng = np.random.default_rng(20)
    time = np.linspace(0.0, 1.0, FRAMES)[:, None]
    start = Posture.rest(line_ends.body.skeleton).plus(rng.normal(0.0, 0.2, 34))
    return start.plus(time * rng.normal(0.0, 0.4, 34))


def simulate(
    line_ends: LineEnds, seed: int, assumed: FilterOptions
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One run of a filter that assumes other noise than OPTIONS, by which the truth moves and is seen.

    Returns:
        (F,) NEES, (F,) NIS and (F,) its degrees of freedom.
    """
    rng = np.random.default_rng(seed)
    body, camera, quality = line_ends.body, line_ends.camera, np.ones(5)
    nature = FuzzyKalmanFilter(line_ends, moving_prior(line_ends), KEYFRAMES, OPTIONS)
    estimator = replace(nature, options=assumed)
    state = estimator.initial()
    truth = state.mean.plus(np.sqrt(np.diag(nature.initial().covariance)) * rng.normal(size=34))
    nees, nis, rows = [], [], []
    for frame in range(FRAMES):
        if frame:
            step, variance = nature.step(state.mean, frame)
            truth = truth.plus(step).plus(np.sqrt(variance) * rng.normal(size=34))
            state = estimator.predict(state, *estimator.step(state.mean, frame))
        pose = body.pose(truth)
        exact = line_ends.evaluate(pose)
        noise = nature.noise_std(exact, exact, quality, line_ends.width_px(pose))
        shown = depths.evaluate(body, camera, pose) + OPTIONS.depth_std_m * rng.normal(size=13)
        estimator.prior_depths[frame] = shown
        done = estimator.correct(state, frame, exact + noise * rng.normal(size=noise.shape), quality)
        state = done.state
        nees.append(float(normalized_squared(truth.minus(state.mean), state.covariance)))
        nis.append(done.normalized_innovation_squared)
        rows.append(done.row_count)
    return np.array(nees), np.array(nis), np.array(rows)


def averages(line_ends: LineEnds, assumed: FilterOptions) -> tuple[list[str], str]:
    """Verdicts on the NEES of some frames over all runs, and on the NIS of all frames and runs."""
    runs = [simulate(line_ends, seed, assumed) for seed in range(RUNS)]
    nees, nis, rows = (np.stack([one[i] for one in runs]) for i in range(3))
    verdicts = []
    for values, degrees in [(nees[:, f], 34) for f in (0, 4, 9, 13)] + [(nis.ravel(), rows.ravel())]:
        average, low, high = chi_square_average(values, degrees, 0.99)
        verdicts.append("timid" if average < low else "overconfident" if average > high else "honest")
    return verdicts[:-1], verdicts[-1]


def test_errors_and_innovations_fit_their_covariances(line_ends: LineEnds) -> None:
    nees, nis = averages(line_ends, OPTIONS)
    assert nees == ["honest"] * 4
    assert nis == "honest"


@pytest.mark.parametrize(("scale", "verdict"), [(0.5, "overconfident"), (2.0, "timid")])
def test_wrong_noise_is_told_by_the_same_measure(line_ends: LineEnds, scale: float, verdict: str) -> None:
    wrong = replace(
        OPTIONS,
        centroid_std_px=OPTIONS.centroid_std_px * scale,
        centroid_std_widths=OPTIONS.centroid_std_widths * scale,
        depth_std_m=OPTIONS.depth_std_m * scale,
        far_width=OPTIONS.far_width * scale,
        near_width=OPTIONS.near_width * scale,
    )
    nees, nis = averages(line_ends, wrong)
    assert nees[1:] == [verdict] * 3
    assert nis == verdict


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "keyframes"), [("walk", "keyframes_noisy.json"), ("aerobic", "keyframes.json")]
)
def test_the_filter_beats_interpolation_and_knows_its_errors(
    take_folder: Callable[[str], Path], name: str, keyframes: str
) -> None:
    folder = take_folder(name)
    take = read_take(folder, folder / keyframes)
    truth = json.loads((folder / "truth.json").read_text())["points"]
    true = np.stack([np.array(truth[point]) for point in take.body.skeleton.point_names], axis=1)
    done = run(reconstruct(take, "ekf"))
    assert done.motion.method == "ekf"
    assert set(done.motion.diagnostics) >= {"normalized_innovation_squared", "gated"}
    between = np.setdiff1d(np.arange(len(true)), done.motion.keyframe_indices)
    error, plain = (
        np.linalg.norm(motion.points - true, axis=-1) for motion in (done.motion, done.interpolation)
    )
    assert error[between].mean() < 0.9 * plain[between].mean()
    assert 0.9 < coverage(error, done.motion.sigma_m) < 0.995
