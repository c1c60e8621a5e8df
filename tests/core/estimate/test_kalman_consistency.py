"""Whether the filter's covariances tell the truth."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from _consistency import coverage, normalized_squared, verdict
from keymark.core.api import reconstruct
from keymark.core.body.posture import Posture
from keymark.core.estimate.kalman import FilterOptions, FuzzyKalmanFilter
from keymark.core.estimate.line_ends import LineEnds
from keymark.core.progress import run
from keymark.core.take.take_file import read_take
from keymark.core.terms.depths import point_depths

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
        shown = point_depths(body, camera, pose, frame) + OPTIONS.depth_std_m * rng.normal(size=13)
        estimator.prior_depths[frame] = shown
        done = estimator.correct(state, frame, exact + noise * rng.normal(size=noise.shape), quality)
        state = done.state
        nees.append(normalized_squared(truth.minus(state.mean), state.covariance))
        nis.append(done.normalized_innovation_squared)
        rows.append(done.row_count)
    return np.array(nees), np.array(nis), np.array(rows)


def averages(line_ends: LineEnds, assumed: FilterOptions) -> tuple[list[str], str]:
    """Verdicts on the NEES of some frames over all runs, and on the NIS of all frames and runs."""
    runs = [simulate(line_ends, seed, assumed) for seed in range(RUNS)]
    nees, nis, rows = (np.stack([one[i] for one in runs]) for i in range(3))
    return [verdict(nees[:, f], 34, 0.99) for f in (0, 4, 9, 13)], verdict(nis.ravel(), rows.ravel(), 0.99)


def test_errors_and_innovations_fit_their_covariances(line_ends: LineEnds) -> None:
    nees, nis = averages(line_ends, OPTIONS)
    assert nees == ["honest"] * 4
    assert nis == "honest"


@pytest.mark.parametrize(("scale", "expected"), [(0.5, "overconfident"), (2.0, "timid")])
def test_wrong_noise_is_told_by_the_same_measure(line_ends: LineEnds, scale: float, expected: str) -> None:
    wrong = replace(
        OPTIONS,
        centroid_std_px=OPTIONS.centroid_std_px * scale,
        centroid_std_widths=OPTIONS.centroid_std_widths * scale,
        depth_std_m=OPTIONS.depth_std_m * scale,
        far_width=OPTIONS.far_width * scale,
        near_width=OPTIONS.near_width * scale,
    )
    nees, nis = averages(line_ends, wrong)
    assert nees[1:] == [expected] * 3
    assert nis == expected


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
