"""Scores against the truth: by hand where it can be, and against another program where it is there."""

from pathlib import Path

import numpy as np
import pytest
from _synthetic_take import BODY, CAMERA, named, true_postures, write_json
from keymark.core.camera.camera import Camera
from keymark.core.errors import InputError
from keymark.core.review.score import read_truth, score_points

FRAMES = 12
EYE_ALONG_Y = Camera.from_dict(CAMERA)
TRUTH = BODY.points(BODY.pose(true_postures(FRAMES)))


def test_the_truth_scores_zero_and_a_shift_of_all_is_an_error_that_rooting_takes_away() -> None:
    score = score_points(TRUTH, TRUTH, [0, 11], EYE_ALONG_Y, np.zeros((FRAMES, 13)))
    assert (score.mpjpe, score.rooted, score.depth, score.image, score.jitter) == (0.0, 0.0, 0.0, 0.0, 0.0)
    assert (score.frames, score.keyframes, score.coverage95) == (FRAMES, 2, 1.0)
    points = TRUTH.copy()
    points[1:] += [0.03, 0.0, 0.0]
    score = score_points(points, TRUTH, [0], EYE_ALONG_Y)
    assert score.mpjpe == pytest.approx(30.0)
    assert score.mpjpe_all == pytest.approx(30.0 * (FRAMES - 1) / FRAMES)
    assert score.rooted == pytest.approx(0.0, abs=1e-9)
    assert score.worst_p95 == pytest.approx(30.0)
    assert score.coverage95 is None


@pytest.mark.parametrize("moves", [False, True])
def test_depth_is_along_the_line_of_sight_and_image_across_it(moves: bool) -> None:
    poses = np.repeat(EYE_ALONG_Y.matrix_world[None], FRAMES, axis=0)
    poses[:, 0, 3] += np.linspace(-2.0, 2.0, FRAMES) * moves
    camera = Camera.from_dict({**CAMERA, "matrix_world_frames": poses.tolist()}) if moves else EYE_ALONG_Y
    sight = TRUTH - poses[:, None, :3, 3]
    sight /= np.linalg.norm(sight, axis=-1, keepdims=True)
    score = score_points(TRUTH + 0.05 * sight, TRUTH, [0], camera)
    assert (score.depth, score.image) == (pytest.approx(50.0), pytest.approx(0.0, abs=1e-6))


def test_jitter_and_skate_are_per_frame() -> None:
    standing = np.repeat(TRUTH[:1], FRAMES, axis=0)
    points = standing.copy()
    points[:, BODY.skeleton.point_names.index("ankle.L"), 0] += 0.01 * np.arange(FRAMES)
    score = score_points(points, standing, [0], EYE_ALONG_Y)
    assert score.skate == pytest.approx(5.0)  # the other ankle stands still
    assert score.jitter == pytest.approx(0.0, abs=1e-9)
    points = standing + 0.01 * (np.arange(FRAMES) % 2)[:, None, None] * np.array([0.0, 0.0, 1.0])
    assert score_points(points, standing, [0], EYE_ALONG_Y).jitter == pytest.approx(20.0)
    running = TRUTH + np.arange(FRAMES)[:, None, None] * np.array([0.1, 0.0, 0.0])
    assert score_points(running, running, [0], EYE_ALONG_Y).skate is None


def test_coverage_is_the_share_within_two_sigma() -> None:
    sigma = np.full((FRAMES, 13), 0.020)
    sigma[: FRAMES // 2] = 0.010
    score = score_points(TRUTH + [0.03, 0.0, 0.0], TRUTH, [0], EYE_ALONG_Y, sigma)
    assert score.coverage95 == pytest.approx(0.5)


def test_what_cannot_be_compared_is_refused() -> None:
    with pytest.raises(InputError, match="11 frames; the truth has 12"):
        score_points(TRUTH[1:], TRUTH, [0], EYE_ALONG_Y)
    with pytest.raises(InputError, match="every frame is a keyframe"):
        score_points(TRUTH, TRUTH, range(FRAMES), EYE_ALONG_Y)


def test_a_truth_file_is_read_and_checked(tmp_path: Path) -> None:
    path = tmp_path / "truth.json"
    value = {"frames": list(range(5, 5 + FRAMES)), "points": named(np.swapaxes(TRUTH, 0, 1))}
    write_json(path, value)
    assert np.array_equal(read_truth(path, 5, FRAMES), TRUTH)
    with pytest.raises(InputError, match=r"truth\.json: frames is .* must list 1 to 12"):
        read_truth(path, 1, FRAMES)
    value["points"]["head"][3] = None
    write_json(path, value)
    with pytest.raises(InputError, match=r"truth\.json: points"):
        read_truth(path, 5, FRAMES)
