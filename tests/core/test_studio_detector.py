"""The studio's detector errs as real ones do, always alike, and the demonstration's keypoints are its own."""

import sys
from pathlib import Path

import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.detect.keypoint_file import read_keypoints, write_keypoints
from keymark.core.detect.keypoints import People
from keymark.core.take.take import evidence_of
from keymark.core.take.take_file import read_take

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

from studio.catalogue import DEMONSTRATION  # noqa: E402
from studio.detector import DEPTH_WANDER_M, POINTS, detect  # noqa: E402
from studio.performance import Performance, principal_points  # noqa: E402

JOINTS = tuple(
    f"{part}.{side}" for part in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle") for side in "LR"
)


@pytest.fixture(scope="module")
def performance() -> Performance:
    """The demonstration's."""
    return DEMONSTRATION.perform(DEMONSTRATION.seed)


def seen_by(performance: Performance, seed: int) -> People:
    """What the detector sees of the demonstration."""
    return detect(performance, DEMONSTRATION.camera, np.random.default_rng(seed))


def errors(performance: Performance, people: People) -> tuple[Array, Array]:
    """(F, 12, 2) errors of the joints in the picture, and (F, 12) of their depths from the hips."""
    points = principal_points(performance, performance.middles)
    names = performance.body.skeleton.point_names
    columns = [names.index(name) for name in JOINTS]
    rows = [people.names.index(name) for name in JOINTS]
    pixel, _ = DEMONSTRATION.camera.project(points[:, columns])
    to_camera = np.linalg.inv(DEMONSTRATION.camera.matrix_world)
    depth = -(points @ to_camera[2, :3] + to_camera[2, 3])
    hips = [names.index(f"hip.{side}") for side in "LR"]
    depth = (depth - depth[:, hips].mean(axis=1, keepdims=True))[:, columns]
    seen = np.full((len(people.frames), len(JOINTS), 5), np.nan)
    for index, frame in enumerate(people.frames):
        if len(frame.pixel):
            seen[index] = np.concatenate([frame.pixel[0, rows], frame.hint_m[0, rows]], axis=-1)
    return seen[..., :2] - pixel, seen[..., 4] - depth


def test_it_errs_as_networks_do(performance: Performance) -> None:
    across, depth = errors(performance, seen_by(performance, DEMONSTRATION.seed))
    away = np.linalg.norm(across, axis=-1)
    assert 1.5 < np.nanmedian(away) < 4.0
    assert np.nanmax(away) > 10.0  # left and right mistaken, or hidden
    jitter = np.nanmedian(np.abs(np.diff(across, axis=0)))
    assert jitter < 0.5 * np.nanmedian(np.abs(across))
    wander = np.nanstd(depth, axis=0)
    assert 0.5 * DEPTH_WANDER_M[0] < np.median(wander) < 1.5 * DEPTH_WANDER_M[1]


def test_left_and_right_are_mistaken_and_frames_are_lost(performance: Performance) -> None:
    people = seen_by(performance, DEMONSTRATION.seed)
    across, _ = errors(performance, people)
    lost = [len(frame.pixel) == 0 for frame in people.frames]
    assert 0 < sum(lost) < 0.1 * len(lost)
    left, right = (JOINTS.index(f"ankle.{side}") for side in "LR")
    mistaken = np.linalg.norm(across[:, [left, right]], axis=-1).min(axis=1) > 8.0
    assert 0 < mistaken.sum() < 0.1 * len(mistaken)
    again, other = seen_by(performance, DEMONSTRATION.seed), seen_by(performance, 1)
    for frame, same in zip(people.frames, again.frames, strict=True):
        assert np.array_equal(frame.pixel, same.pixel, equal_nan=True)
    assert not np.array_equal(people.frames[0].pixel, other.frames[0].pixel)


def test_the_demonstration_has_what_the_detector_sees(
    performance: Performance, repository: Path, tmp_path: Path
) -> None:
    folder = repository / "presets" / "demo" / "aerobic"
    made = seen_by(performance, DEMONSTRATION.seed)
    write_keypoints(tmp_path / "made.json", made, 1, 30)
    fresh, stored = (
        read_keypoints(file, 118, (320, 240)) for file in (tmp_path / "made.json", folder / "keypoints.json")
    )
    assert stored.names == POINTS
    for one, two in zip(fresh.frames, stored.frames, strict=True):
        for name in ("pixel", "score", "hint_m"):
            assert getattr(one, name) == pytest.approx(getattr(two, name), abs=0.11, nan_ok=True)
    assert evidence_of(read_take(folder)) == ("markers", "contours")
    assert evidence_of(read_take(folder, whole=True)) == ("markers", "keypoints", "depth_hints", "contours")
