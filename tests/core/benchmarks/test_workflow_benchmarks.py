"""The computations of the workflow's benchmarks."""

import sys

import numpy as np
import pytest
from _boot import ROOT
from _synthetic_take import write_synthetic_take

sys.path.insert(0, str(ROOT / "benchmarks"))

import again  # noqa: E402
import finishing  # noqa: E402
import posing  # noqa: E402
import suggestions  # noqa: E402
from keyframing import exact_postures  # noqa: E402
from keymark.core.estimate.reconstruct import reconstruct  # noqa: E402
from takes import group_of  # noqa: E402
from trials import Trial, read_trial, run  # noqa: E402

FRAMES = 24


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """A small synthetic take with its tracks and its truth."""
    return read_trial(write_synthetic_take(tmp_path_factory.mktemp("workflow") / "take", FRAMES))


def test_a_pose_is_as_far_off_as_it_was_moved(trial: Trial) -> None:
    """Distances across the line of sight and along it."""
    exact = exact_postures(trial)[9]
    sideways, deeper = np.zeros((2, trial.take.body.skeleton.dof_count))
    sideways[0], deeper[1] = 0.05, 0.05
    assert posing.distances(trial, exact.plus(sideways), 9) == pytest.approx((0.05, 0.05), rel=0.02)
    whole, across = posing.distances(trial, exact.plus(deeper), 9)
    assert whole == pytest.approx(0.05, rel=0.02) and across < 0.01


def test_every_keyframe_is_fitted_from_each_start_that_it_has(trial: Trial) -> None:
    """The first has no earlier keyframe, and neither end lies between two; the markers' distance falls."""
    found = posing.measure(trial)
    assert [len(fits) for fits in found.values()] == [3, 2]
    means = {start: posing.summary(fits) for start, fits in found.items()}
    for one in means.values():
        assert one["fit_px"] < one["start_px"] and one["across_fit_mm"] <= one["fit_mm"]
    assert means["earlier"]["worse"] == np.mean([fit.fit_mm > fit.start_mm for fit in found["earlier"]])
    assert means["between"]["fit_mm"] < means["earlier"]["fit_mm"]
    assert posing.table({"take": means}).count("| take |") == 1 + len(means)


def test_the_gain_of_a_keyframe_is_the_decrease_of_the_error(trial: Trial) -> None:
    """A keyframe in a posed frame changes nothing; confidence is compared with the truth."""
    postures = exact_postures(trial)
    judged = suggestions.judge(trial, postures, 2)
    more = suggestions.error_with(trial, postures, np.array([0, FRAMES - 1]), 11)
    assert judged.gains_mm["widest gap"] == pytest.approx(judged.error_mm - 1e3 * more)
    again_mm = 1e3 * suggestions.error_with(trial, postures, np.array([0, FRAMES - 1]), 0)
    assert again_mm == pytest.approx(judged.error_mm)
    assert len(judged.confidence) == len(judged.within) == FRAMES - 2
    assert -1.0 <= judged.rank <= 1.0


def test_calibration_compares_claims_with_the_truth() -> None:
    """Frames are binned by their claimed confidence."""
    judged = suggestions.Judged(10.0, {}, 0, 0.0, [0.2, 0.4, 0.95], [0.5, 0.7, 1.0])
    low, *between, high = suggestions.calibration([judged])
    assert low == (2, pytest.approx(0.3), pytest.approx(0.6)) and high == (1, 0.95, 1.0)
    assert [frames for frames, *_ in between] == [0, 0]
    assert "0.30 / 0.60 (2)" in suggestions.calibration_table({"given": [judged]})


def test_random_frames_lie_as_far_from_keyframes_as_suggested_ones(trial: Trial) -> None:
    """Random frames are the same in every run."""
    frames = np.array([0, 12, FRAMES - 1])
    found = suggestions.random_frames(trial, frames)
    assert len(set(found)) == suggestions.RANDOM_FRAMES
    assert np.abs(np.array(found)[:, None] - frames).min() >= suggestions.NEAREST_FRAMES
    assert found == suggestions.random_frames(trial, frames)
    assert suggestions.middle_of_widest_gap(frames) == 6


def test_a_tighter_tolerance_costs_more_keys(trial: Trial) -> None:
    """A looser tolerance needs fewer keys; keys within a tolerance keep the error within it."""
    row = finishing.finished(trial, exact_postures(trial))
    assert row["keyframes"] <= row["reduced 20"] <= row["reduced 5"]
    assert row["keyframes"] <= row["even 20"] <= row["even 5"]
    body, times = trial.take.body, np.arange(FRAMES, dtype=np.float64)
    rig = finishing.quaternion_rig(body)
    values = finishing.rig_values(rig, exact_postures(trial), body)
    posed = np.array(trial.take.keyframe_indices)
    assert row["even 5"] < finishing.even_keys(rig, times, values, posed, 2e-4) <= FRAMES
    assert row["mpjpe"] < 0.1 and row["baked"] <= finishing.BAKED_MM
    assert "| take |" in finishing.table({"take": row}, {}, finishing.COLUMNS)[0]


def test_changes_of_a_take_are_one_keyframe_each(trial: Trial) -> None:
    """Added in the widest gap, deleted or posed otherwise in the middle."""
    take, postures = trial.take, exact_postures(trial)
    assert take.keyframe_indices == (0, 8, 16, 23)
    assert again.one_added(take, postures).keyframe_indices == (0, 4, 8, 16, 23)
    assert again.one_deleted(take, postures).keyframe_indices == (0, 8, 23)
    moved = again.one_moved(take, postures)
    same = [a.posture is b.posture for a, b in zip(take.keyframes, moved.keyframes, strict=True)]
    assert same == [True, True, False, True]


def test_an_unchanged_take_is_not_estimated_again(trial: Trial) -> None:
    """Reconstructing an unchanged take again gives the same motion."""
    first = run(reconstruct(trial.take, "map", trial.reading))
    once_more = again.compared(trial.take, first)
    assert once_more.largest_mm == once_more.moved_mm == 0.0 and once_more.cost < 1.0


def test_takes_are_grouped_by_folder(trial: Trial) -> None:
    """The demonstration belongs to the takes with which methods are tuned."""
    assert group_of(ROOT / "presets" / "demo" / "aerobic") == "given"
    assert group_of(trial.take.folder) == "studio"
