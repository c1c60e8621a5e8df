"""The computations of the benchmarks."""

import sys

import numpy as np
import pytest
from _boot import ROOT
from _synthetic_take import write_synthetic_take

sys.path.insert(0, str(ROOT / "benchmarks"))

from accuracy import measure, point_table  # noqa: E402
from keyframing import exact_postures, hand_posed, keyed, spread_frames  # noqa: E402
from mistakes import (  # noqa: E402
    doubled_speed,
    mistimed,
    posed_through_lens,
    shifted,
    with_segments,
)
from threshold import needed_for  # noqa: E402
from trials import Trial, read_trial  # noqa: E402

FRAMES = 24
HIPS = slice(7, 9)


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """A small synthetic take with its tracks and its truth."""
    return read_trial(write_synthetic_take(tmp_path_factory.mktemp("benchmarks") / "take", FRAMES))


def test_the_needed_density_is_where_the_curve_crosses_the_limit() -> None:
    assert needed_for(40.0, [4.0, 8.0, 16.0], [60.0, 50.0, 30.0]) == pytest.approx(np.sqrt(8.0 * 16.0))
    assert needed_for(40.0, [4.0, 8.0, 16.0], [60.0, 35.0, 45.0]) is None
    assert needed_for(40.0, [4.0, 8.0, 16.0], [39.0, 30.0, 20.0]) == 4.0
    assert needed_for(40.0, [3.0, 4.0, 5.0, 6.0], [50.0, 30.0, 40.1, 30.1]) == pytest.approx(5.0, abs=0.02)


def test_generated_keyframes_match_the_truth(trial: Trial) -> None:
    frames = spread_frames(trial, 5)
    assert frames[0] == 0 and frames[-1] == FRAMES - 1 and set(np.diff(frames)) <= {5, 6}
    body, exact = trial.take.body, exact_postures(trial)
    assert np.abs(body.points(body.pose(exact)) - trial.truth).max() < 1e-3
    for rms_m in (0.012, 0.05):
        posed = hand_posed(trial, exact, rms_m)
        error = body.points(body.pose(posed)) - trial.truth
        assert np.sqrt(np.mean(np.sum(error**2, axis=-1))) == pytest.approx(rms_m, rel=0.06)
        assert np.array_equal(posed.translation, hand_posed(trial, exact, rms_m).translation)
    few = keyed(trial, exact, frames)
    assert few.take.keyframe_indices == few.unscored == tuple(frames)
    assert few.best_interpolation().keyframes == 5


def test_shifted_frames_stay_in_the_clip_and_in_order() -> None:
    assert shifted([0, 8, 16, 23], [2, -2, 1, -1], FRAMES).tolist() == [2, 6, 17, 22]
    assert shifted([0, 8, 16, 23], [-2, 2, 2, 2], FRAMES).tolist() == [0, 10, 18, 23]
    assert shifted([0, 1, 22, 23], [2, -2, 2, 1], FRAMES).tolist() == [2, 3, 22, 23]


def test_mistimed_keyframes_keep_their_postures_and_the_frames_that_are_scored(trial: Trial) -> None:
    late = mistimed(trial, [1, 1, 1, 1])
    assert late.take.keyframe_indices == (1, 9, 17, 23) and late.unscored == (0, 8, 16, 23)
    for before, after in zip(trial.take.keyframes, late.take.keyframes, strict=True):
        assert after.posture is before.posture
    assert late.best_interpolation().mpjpe > 1.1 * trial.best_interpolation().mpjpe


def test_keyframes_posed_over_a_wrong_lens_look_the_same_in_the_picture(trial: Trial) -> None:
    other = posed_through_lens(trial, 1.1)
    index = list(trial.take.keyframe_indices)
    posed = other.take.body.points(other.take.body.pose(other.take.keyframes[1].posture))
    assert np.abs(posed - other.truth[index[1]]).max() < 1e-3
    pixels = [one.take.camera.project(one.truth[:, HIPS].mean(axis=1))[0] for one in (trial, other)]
    assert pixels[1] == pytest.approx(pixels[0], abs=1e-6)
    depth = [one.take.camera.depth(one.truth[:, HIPS].mean(axis=1)) for one in (trial, other)]
    assert depth[1] == pytest.approx(1.1 * depth[0])


def test_other_segments_nearly_keep_the_posed_points(trial: Trial) -> None:
    other = with_segments(trial, {"forearm.L": 1.05})
    lengths = [one.take.body.actor.segments_m for one in (trial, other)]
    assert lengths[1]["forearm.L"] == pytest.approx(1.05 * lengths[0]["forearm.L"])
    assert lengths[1]["forearm.R"] == lengths[0]["forearm.R"]
    points = [
        one.take.body.points(one.take.body.pose(one.take.keyframes[1].posture)) for one in (trial, other)
    ]
    assert 1e-4 < np.abs(points[1] - points[0]).max() < 0.05 * lengths[0]["forearm.L"]


def test_doubled_speed_has_half_the_frames_in_half_the_time(trial: Trial) -> None:
    fast = doubled_speed(trial)
    assert len(fast.truth) == fast.tracks.frame_count == fast.take.frame_count == FRAMES // 2
    assert fast.tracks.time_s[-1] == pytest.approx(11 / 30.0)
    assert fast.take.keyframe_indices == (0, 4, 8, 11)
    assert doubled_speed(trial, every_keyframe=2).take.keyframe_indices == (0, 8, 11)
    assert fast.best_interpolation().mpjpe_all < 60.0
    assert np.isfinite(fast.estimated("map").points).all()


def test_the_mean_of_the_points_errors_is_the_score(trial: Trial) -> None:
    found = measure(trial)
    for one in found.values():
        assert np.mean(list(one.points_mm.values())) == pytest.approx(one.score.mpjpe, abs=1e-3)
    assert found["map"].score.coverage95 is not None and found["prior"].score.coverage95 is None
    assert point_table({"take": {"exact": found}}).count("| exact |") == len(found) == 5
