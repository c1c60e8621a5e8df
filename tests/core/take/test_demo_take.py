"""The examples that come along: valid, small, and telling the truth about their own footage."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN
from keymark.core.camera.camera import Camera
from keymark.core.review.score import read_truth
from keymark.core.take.read_footage import open_clip
from keymark.core.take.take import Take, evidence_of
from keymark.core.take.take_file import read_take

LARGEST_FOLDER_BYTES = {"aerobic": 500_000, "greeting": 400_000}
each_example = pytest.mark.parametrize("folder", LARGEST_FOLDER_BYTES, indirect=True)
"""Runs a test with the demonstration and with the example in plain clothes; others see the first alone."""
MARKER_ENDS = {
    "trunk": (("hip.L", "hip.R"), ("shoulder.L", "shoulder.R")),
    "forearm.L": (("elbow.L",), ("wrist.L",)),
    "forearm.R": (("elbow.R",), ("wrist.R",)),
    "shin.L": (("knee.L",), ("ankle.L",)),
    "shin.R": (("knee.R",), ("ankle.R",)),
}


@pytest.fixture(scope="module")
def folder(repository: Path, request: pytest.FixtureRequest) -> Path:
    return repository / "presets" / "demo" / getattr(request, "param", "aerobic")


@pytest.fixture(scope="module")
def take(folder: Path) -> Take:
    return read_take(folder)


@pytest.fixture(scope="module")
def truth(folder: Path, take: Take) -> Array:
    assert take.frame_count is not None
    return read_truth(folder / "truth.json", take.frame_start, take.frame_count)


def _posed_points(take: Take) -> Array:
    return np.stack([take.body.points(take.body.pose(keyframe.posture)) for keyframe in take.keyframes])


@each_example
def test_the_folder_is_small(folder: Path) -> None:
    assert sum(file.stat().st_size for file in folder.iterdir()) < LARGEST_FOLDER_BYTES[folder.name]


@each_example
def test_the_folder_says_what_is_allowed(folder: Path) -> None:
    assert "GPL-3.0-or-later" in (folder / "LICENSE.txt").read_text(encoding="utf-8")


@pytest.mark.parametrize("folder", ["greeting"], indirect=True)
def test_in_plain_clothes_there_are_keypoints_and_contours(folder: Path) -> None:
    take = read_take(folder, whole=True)
    clip = open_clip(take)
    assert (clip.frame_count, clip.size, clip.fps) == (132, (320, 240), 30.0)
    assert evidence_of(take) == ("keypoints", "depth_hints", "contours")
    (people,) = take.keypoints
    assert np.mean([len(frame.pixel) == 1 for frame in people.frames]) > 0.95
    assert len(take.keyframes) == 10


def test_the_clip_is_what_the_take_says(take: Take) -> None:
    clip = open_clip(take)
    assert (clip.frame_count, clip.size, clip.fps) == (118, (320, 240), 30.0)
    assert len(take.markers) == 5
    assert len(take.keyframes) == 12


def test_the_side_view_has_the_same_frames(folder: Path) -> None:
    side = json.loads((folder / "side.json").read_text(encoding="utf-8"))
    camera = Camera.from_dict(side["camera"], "side.json: camera")
    capture = cv2.VideoCapture(str(folder / side["clip"]))
    sizes = []
    while True:
        ok, image = capture.read()
        if not ok:
            break
        sizes.append((image.shape[1], image.shape[0]))
    assert sizes == [camera.resolution] * 118


@each_example
def test_exact_keyframes_are_the_truth(take: Take, truth: Array) -> None:
    indices = [keyframe.index for keyframe in take.keyframes]
    assert np.abs(_posed_points(take) - truth[indices]).max() < 1e-5


@each_example
def test_hand_posed_keyframes_err_as_people_do(folder: Path, take: Take, truth: Array) -> None:
    by_hand = read_take(folder, folder / "keyframes_noisy.json")
    indices = [keyframe.index for keyframe in by_hand.keyframes]
    assert indices == [keyframe.index for keyframe in take.keyframes]
    posed = _posed_points(by_hand)
    error = posed - truth[indices]
    assert np.sqrt(np.mean(np.sum(error**2, axis=-1))) == pytest.approx(0.025, abs=5e-4)
    depth = error @ take.camera.matrix_world[:3, 2]
    across = np.sqrt(np.sum(error**2, axis=-1) - depth**2)
    assert np.sqrt(np.mean(depth**2)) > np.sqrt(np.mean(across**2) / 2.0)
    for (first_names, last_names), name in zip(MARKER_ENDS.values(), MARKER_ENDS, strict=True):
        if name != "trunk":
            ends = [posed[:, HUMAN.point_names.index(names[0])] for names in (first_names, last_names)]
            length = np.linalg.norm(ends[1] - ends[0], axis=-1)
            assert length == pytest.approx(take.body.actor.segments_m[name], abs=1e-5)
