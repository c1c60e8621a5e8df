"""What the benchmarks compute before they print it."""

import sys

import numpy as np
import pytest
from _boot import ROOT
from _synthetic_take import write_synthetic_take

sys.path.insert(0, str(ROOT / "benchmarks"))

from curves import needed_for  # noqa: E402
from keyframing import exact_postures, hand_posed, keyed, spread_frames  # noqa: E402
from trials import Trial, read_trial  # noqa: E402

FRAMES = 24


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """A small synthetic take with its tracks and its truth."""
    return read_trial(write_synthetic_take(tmp_path_factory.mktemp("benchmarks") / "take", FRAMES))


def test_the_density_that_is_needed_lies_where_the_curve_crosses_the_limit() -> None:
    """Straight over the logarithm between measured densities, behind the last one beyond the limit."""
    assert needed_for(40.0, [4.0, 8.0, 16.0], [60.0, 50.0, 30.0]) == pytest.approx(np.sqrt(8.0 * 16.0))
    assert needed_for(40.0, [4.0, 8.0, 16.0], [60.0, 35.0, 45.0]) is None
    assert needed_for(40.0, [4.0, 8.0, 16.0], [39.0, 30.0, 20.0]) == 4.0
    assert needed_for(40.0, [3.0, 4.0, 5.0, 6.0], [50.0, 30.0, 40.1, 30.1]) == pytest.approx(5.0, abs=0.02)


def test_keyframes_of_any_frames_stand_where_the_truth_does(trial: Trial) -> None:
    """Exact ones within a millimetre; hand-posed ones by as much off as asked, the same in every run."""
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


def test_the_best_interpolation_is_none_of_the_worse(trial: Trial) -> None:
    """It is the nearest to the truth of those that are tried."""
    every = [trial.score(points).mpjpe for points in trial.interpolated().values()]
    assert len(every) == 3 and trial.best_interpolation().mpjpe == min(every) < max(every)
