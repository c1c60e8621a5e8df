"""The benchmarks: each can be imported, levers have what they replace, and errors are put in as stated."""

import importlib
import sys

import numpy as np
import pytest
from _boot import ROOT
from _synthetic_take import write_synthetic_take

sys.path.insert(0, str(ROOT / "benchmarks"))

from accuracy import measure, point_table  # noqa: E402
from keyframing import exact_postures, hand_posed, keyed, spread_frames  # noqa: E402
from mistakes import doubled_speed, mistimed, posed_through_lens, shifted  # noqa: E402
from threshold import needed_for  # noqa: E402
from trials import Trial, read_trial  # noqa: E402

FRAMES = 24
HIPS = slice(7, 9)
MODULES = sorted(file.stem for file in (ROOT / "benchmarks").glob("*.py"))


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """A small synthetic take with its tracks and its truth."""
    return read_trial(write_synthetic_take(tmp_path_factory.mktemp("benchmarks") / "take", FRAMES))


@pytest.mark.parametrize("name", MODULES)
def test_a_benchmark_finds_what_it_imports(name: str) -> None:
    try:
        importlib.import_module(name)
    except ModuleNotFoundError as missing:
        if missing.name not in ("bpy", "mathutils", "mediapipe"):  # some are of another Python
            raise


def test_every_lever_has_what_it_replaces() -> None:
    levers = importlib.import_module("levers")
    switches = [switch for lever in levers.OFF.values() for switch in lever]
    assert len(switches) > 20
    assert [name for module, name, _ in switches if not hasattr(module, name)] == []


def test_the_needed_density_is_where_the_curve_crosses_the_limit() -> None:
    assert needed_for(40.0, [4.0, 8.0, 16.0], [60.0, 50.0, 30.0]) == pytest.approx(np.sqrt(8.0 * 16.0))
    assert needed_for(40.0, [4.0, 8.0, 16.0], [60.0, 35.0, 45.0]) is None
    assert needed_for(40.0, [4.0, 8.0, 16.0], [39.0, 30.0, 20.0]) == 4.0


def test_generated_keyframes_match_the_truth(trial: Trial) -> None:
    frames = spread_frames(trial, 5)
    assert frames[0] == 0 and frames[-1] == FRAMES - 1 and set(np.diff(frames)) <= {5, 6}
    body, exact = trial.take.body, exact_postures(trial)
    assert np.abs(body.points(body.pose(exact)) - trial.truth).max() < 1e-3
    posed = hand_posed(trial, exact, 0.025)
    error = body.points(body.pose(posed)) - trial.truth
    assert np.sqrt(np.mean(np.sum(error**2, axis=-1))) == pytest.approx(0.025, rel=0.06)
    assert np.array_equal(posed.translation, hand_posed(trial, exact, 0.025).translation)
    few = keyed(trial, exact, frames)
    assert few.take.keyframe_indices == few.unscored == tuple(frames)


def test_errors_are_put_in_as_stated(trial: Trial) -> None:
    assert shifted([0, 8, 16, 23], [2, -2, 1, -1], FRAMES).tolist() == [2, 6, 17, 22]
    assert shifted([0, 1, 22, 23], [2, -2, 2, 1], FRAMES).tolist() == [2, 3, 22, 23]
    late = mistimed(trial, [1, 1, 1, 1])
    assert late.take.keyframe_indices == (1, 9, 17, 23) and late.unscored == (0, 8, 16, 23)
    fast = doubled_speed(trial)
    assert len(fast.truth) == fast.tracks.frame_count == fast.take.frame_count == FRAMES // 2
    assert fast.take.keyframe_indices == (0, 4, 8, 11)
    other = posed_through_lens(trial, 1.1)
    pixels = [one.take.camera.project(one.truth[:, HIPS].mean(axis=1))[0] for one in (trial, other)]
    assert pixels[1] == pytest.approx(pixels[0], abs=1e-6)
    depth = [one.take.camera.depth(one.truth[:, HIPS].mean(axis=1)) for one in (trial, other)]
    assert depth[1] == pytest.approx(1.1 * depth[0])


def test_the_mean_of_the_points_errors_is_the_score(trial: Trial) -> None:
    found = measure(trial)
    for one in found.values():
        assert np.mean(list(one.points_mm.values())) == pytest.approx(one.score.mpjpe, abs=1e-3)
    assert found["map"].score.coverage95 is not None and found["prior"].score.coverage95 is None
    assert point_table({"take": {"exact": found}}).count("| exact |") == len(found) == 5
