"""The benchmark of found cameras: its rooms, its clicks, and keyframes seen through another camera."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from _boot import ROOT
from _synthetic_take import write_synthetic_take

sys.path.insert(0, str(ROOT / "benchmarks"))

import camera_room  # noqa: E402
from camera import LINES, PERFORMER, PUT, cameras_of, seen_through  # noqa: E402
from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.footage.camera_fields import CameraPlacement  # noqa: E402
from keymark.core.footage.camera_fit import HEIGHT, LENS, TILT  # noqa: E402
from trials import Trial, read_trial  # noqa: E402


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """A small synthetic take with its truth."""
    return read_trial(write_synthetic_take(tmp_path_factory.mktemp("benchmarks") / "take", 12))


def test_keyframes_through_another_camera_look_the_same(trial: Trial) -> None:
    body, true = trial.take.body, trial.take.camera
    index = np.array(trial.take.keyframe_indices)
    seen, _ = true.project(trial.truth[index])
    placement = CameraPlacement(1.6, float(np.radians(-7.0)), float(np.radians(2.0)))
    other = replace(true, matrix_world=placement.applied_to(true.matrix_world))
    for camera, far_px in ((other, 0.3), (replace(other, lens_mm=1.2 * true.lens_mm), 4.0)):
        posture = Posture.stack([keyframe.posture for keyframe in seen_through(trial, camera)])
        points = body.points(body.pose(posture))
        assert np.abs(camera.project(points)[0] - seen).max() < far_px
        assert np.abs(points - trial.truth[index]).max() > 0.05


def test_without_a_hands_errors_a_room_gives_its_camera(
    trial: Trial, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(camera_room, "HAND_PX", 0.0)
    found = cameras_of(tmp_path, trial.take, trial.truth, True)
    assert len(found[PUT]) == 1 and set(found[PUT][0].kept) == {"height", "tilt", "roll", "lens"}
    determined = [one for one in found[LINES] if one.kept == (LENS,)]
    assert len(determined) > 0.7 * len(found[LINES])
    for one in determined:
        assert abs(np.degrees(one.error[TILT])) < 1.5 and abs(one.error[HEIGHT]) < 0.2
    assert all(one.kept for one in found[PERFORMER])  # in one place: not all of it is determined
