"""A camera that shakes, zooms or walks is told from one that stands still by its background."""

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from keymark.core.api import reconstruct
from keymark.core.body.rotations import exponential
from keymark.core.camera.camera import Camera
from keymark.core.camera.camera_motion import camera_motion, moved
from keymark.core.detect.keypoints import Keypoints
from keymark.core.markers.reading import Reading
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.progress import run
from keymark.core.review.score import score_points
from keymark.core.take.steady_camera import camera_matrix, followed_camera, steadied
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.core.video.album import Album

from tests._synthetic_take import write_synthetic_take

ROOT = Path(__file__).resolve().parents[3]
CASES = ROOT.parent / "shared" / "failing"
WALK = ROOT.parent / "shared" / "plain_takes" / "plain_walk"
SIZE, FRAMES = (320, 240), 12
CAMERA = Camera(35.0, 36.0, SIZE, np.eye(4))
MATRIX = camera_matrix(CAMERA)
NOTHING = np.full((FRAMES, 1, 2), np.nan)


def room() -> np.ndarray:
    """A wall of soft blotches (rows, columns, 3), which has corners everywhere."""
    noise = np.random.default_rng(5).uniform(0.0, 255.0, (24, 32, 3)).astype(np.float32)
    return cv2.resize(noise, SIZE, interpolation=cv2.INTER_CUBIC).clip(0.0, 255.0).astype(np.uint8)


def turned(angle: np.ndarray, zoom: float = 1.0) -> np.ndarray:
    return MATRIX @ np.diag([zoom, zoom, 1.0]) @ exponential(angle) @ np.linalg.inv(MATRIX)


def filmed(homographies: list[np.ndarray]) -> Album:
    album, wall = Album(), room()
    for index, one in enumerate(homographies):
        album.add(index, cv2.warpPerspective(wall, one, SIZE, borderMode=cv2.BORDER_REPLICATE))
    return album


def shaking() -> list[np.ndarray]:
    """Turns of up to a degree and a half about all axes, whose mean is none."""
    phase = 2.0 * np.pi * np.arange(FRAMES) / FRAMES
    return [turned(0.025 * np.array([np.sin(p), np.cos(p), 0.5 * np.sin(2.0 * p)])) for p in phase]


def test_a_camera_that_shakes_is_followed_to_a_fraction_of_a_pixel() -> None:
    found = camera_motion(filmed(shaking()), np.arange(FRAMES), NOTHING, MATRIX, SIZE)
    assert found is not None and found.noticed and found.turns
    middle = np.array([160.0, 120.0])
    expected = np.stack([moved(one, middle) for one in shaking()])
    np.testing.assert_allclose(moved(found.homography, middle), expected, atol=0.6)


def test_a_camera_that_zooms_keeps_the_view_of_the_first_frame() -> None:
    zooms = np.linspace(1.0, 1.3, FRAMES)
    found = camera_motion(
        filmed([turned(np.zeros(3), zoom) for zoom in zooms]), np.arange(FRAMES), NOTHING, MATRIX, SIZE
    )
    assert found is not None and found.noticed and found.turns
    np.testing.assert_allclose(found.zoom, 1.3, atol=0.01)
    corner = moved(found.homography, np.array([0.0, 120.0]))
    np.testing.assert_allclose(corner[:, 0], 160.0 - 160.0 * zooms, atol=0.6)


def test_a_camera_that_stands_still_is_not_noticed() -> None:
    found = camera_motion(filmed([np.eye(3)] * FRAMES), np.arange(FRAMES), NOTHING, MATRIX, SIZE)
    assert found is not None and not found.noticed and found.moved_px < 0.2


def walking() -> Album:
    """Stripes near the camera that move six times as far as the wall behind them."""
    album, wall = Album(), room()
    near = np.random.default_rng(6).permuted(wall, axis=0)
    near = cv2.GaussianBlur(near, (0, 0), 2.0)
    for index in range(FRAMES):
        image = np.roll(wall, index, axis=1)
        for column in range(0, 320, 64):
            image[:, column : column + 32] = np.roll(near, 6 * index, axis=1)[:, column : column + 32]
        album.add(index, image)
    return album


def test_a_camera_that_walks_moves_near_things_more_than_far_ones() -> None:
    found = camera_motion(walking(), np.arange(FRAMES), NOTHING, MATRIX, SIZE)
    assert found is None or (found.noticed and not found.turns)


@pytest.fixture
def take(tmp_path: Path) -> Take:
    """A take without markers before the camera of this file."""
    whole = read_take(write_synthetic_take(tmp_path / "take"))
    return replace(whole, keyframes=(), markers=(), camera=CAMERA)


def test_what_a_turning_camera_sees_is_taken_back_and_its_turns_are_known(take: Take) -> None:
    still = np.tile([[200.0, 100.0]], (FRAMES, 1, 1))
    seen = np.stack([moved(one, still[0]) for one in shaking()])
    tracks = replace(
        RegionTracks.unmarked(np.arange(FRAMES) / 30.0, SIZE),
        names=("spot",),
        centroid=seen,
        second_moment=np.tile(9.0 * np.eye(2), (FRAMES, 1, 1, 1)),
        area=np.full((FRAMES, 1), 40.0),
        quality=np.ones((FRAMES, 1)),
        clipped=np.zeros((FRAMES, 1), dtype=bool),
    )
    reading = Reading(tracks, filmed(shaking()))
    _, steady, notes = run(steadied(take, reading, Keypoints.none(FRAMES)))
    np.testing.assert_allclose(steady.tracks.centroid, still, atol=0.8)
    assert "the camera turns" in steady.notes[-1]
    assert notes == ()
    ahead = np.array([0.3, 0.2, -5.0])
    pixel, _ = followed_camera(take, steady).project(np.tile(ahead, (FRAMES, 1)), np.arange(FRAMES))
    expected = moved(steady.steady, CAMERA.project(ahead)[0])
    np.testing.assert_allclose(pixel, expected, atol=0.3)


def test_the_reading_of_a_camera_that_stands_still_stays_as_it_is(take: Take) -> None:
    reading = Reading(RegionTracks.unmarked(np.arange(FRAMES) / 30.0, SIZE), filmed([np.eye(3)] * FRAMES))
    same, steady, notes = run(steadied(take, reading, Keypoints.none(FRAMES)))
    assert same is take and steady is reading and notes == ()


@pytest.mark.slow
@pytest.mark.skipif(not CASES.is_dir(), reason="the reported cases are not beside the repository")
def test_a_hand_held_camera_costs_little_accuracy() -> None:
    take = read_take(CASES / "04-hand-held", WALK / "keyframes.json")
    result = run(reconstruct(take))
    truth = json.loads((WALK / "truth.json").read_text())["points"]
    true = np.stack([np.array(truth[name]) for name in take.body.skeleton.point_names], axis=1)
    motion = result.motion
    score = score_points(motion.points, true, motion.keyframe_indices, take.camera)
    assert score.mpjpe < 25.0  # 73 where it is taken to stand still
    assert not any("early or late" in note for note in result.notes)
