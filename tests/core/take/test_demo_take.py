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
WHOLE_SHARE = 0.85
"""A marker that shows this share of the most pixels it ever shows is hardly hidden."""


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


def _ends(truth: Array, marker: str) -> tuple[Array, Array]:
    """World places (F, 3) of the two ends of a marker's segment."""
    first, last = (
        np.mean([truth[:, HUMAN.point_names.index(name)] for name in names], axis=0)
        for names in MARKER_ENDS[marker]
    )
    return first, last


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


@pytest.mark.parametrize("marker", MARKER_ENDS)
def test_the_regions_lie_on_the_true_segments(folder: Path, take: Take, truth: Array, marker: str) -> None:
    visible = json.loads((folder / "visibility.json").read_text(encoding="utf-8"))[marker]
    pixels = np.array(visible["pixels"])
    centroid = np.array([place or [np.nan, np.nan] for place in visible["centroid"]], dtype=np.float64)
    first, _ = take.camera.project(_ends(truth, marker)[0])
    last, depth = take.camera.project(_ends(truth, marker)[1])
    along = last - first
    length = np.linalg.norm(along, axis=-1)
    share = np.sum((centroid - first) * along, axis=-1) / length**2
    away = centroid - first
    offset = np.abs(along[:, 0] * away[:, 1] - along[:, 1] * away[:, 0]) / length
    half_width_px = (0.09 if marker == "trunk" else 0.045) * take.camera.focal_px / depth
    full_length = np.linalg.norm(np.subtract(*_ends(truth, marker)), axis=-1) * take.camera.focal_px / depth
    whole = (pixels > WHOLE_SHARE * pixels.max()) & (length > 0.5 * full_length)
    assert whole.sum() >= 10
    assert np.all((share[whole] > 0.25) & (share[whole] < 0.8))
    assert np.all(offset[whole] < half_width_px[whole])


def test_the_footage_shows_each_color_where_it_is_said_to_be(folder: Path, take: Take) -> None:
    visibility = json.loads((folder / "visibility.json").read_text(encoding="utf-8"))
    images = [image for _, _, image in open_clip(take).frames()]
    for style in take.markers:
        visible = visibility[style.name]
        near = []
        for image, pixels, place in zip(images, visible["pixels"], visible["centroid"], strict=True):
            if pixels > WHOLE_SHARE * max(visible["pixels"]):
                column, row = (int(value) for value in place)
                shown = image[row - 1 : row + 2, column - 1 : column + 2, ::-1].reshape(-1, 3).mean(axis=0)
                near.append(np.abs(shown - style.color_srgb).max() < 60.0)
        assert np.mean(near) > 0.9, style.name


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
