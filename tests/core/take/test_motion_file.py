"""`motion.json`: what it holds, and that it is read back."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _synthetic_take import BODY, true_postures
from keymark.core.errors import ConversionError, InputError
from keymark.core.take.motion import Motion, read_motion, write_motion

FRAMES = 10


@pytest.fixture
def motion() -> Motion:
    """A motion with uneven time stamps, a full covariance and diagnostics with gaps."""
    random = np.random.default_rng(3)
    posture = true_postures(FRAMES)
    root = 0.02 * random.normal(size=(FRAMES, 13, 3, 3))
    quality = random.random((FRAMES, 5))
    quality[2, 1] = np.nan
    return Motion(
        BODY,
        29.97,
        101,
        np.cumsum(random.uniform(0.02, 0.05, FRAMES)),
        posture,
        BODY.points(BODY.pose(posture)),
        root @ np.swapaxes(root, -1, -2),
        (0, 4, 9),
        "map",
        {"quality": quality, "posing_scale": np.array(1.25)},
    )


def test_a_motion_is_read_back(motion: Motion, tmp_path: Path) -> None:
    write_motion(motion, tmp_path / "motion.json")
    back = read_motion(tmp_path / "motion.json")
    assert (back.fps, back.frame_start, back.method) == (29.97, 101, "map")
    assert back.keyframe_indices == motion.keyframe_indices
    assert dict(back.body.actor.segments_m) == dict(BODY.actor.segments_m)
    assert np.allclose(back.time_s, motion.time_s, atol=1e-6, rtol=0)
    assert np.allclose(back.points, motion.points, atol=1e-6, rtol=0)
    assert np.abs(back.posture.minus(motion.posture)).max() < 3e-6
    assert np.allclose(back.point_covariance, motion.point_covariance, rtol=1e-5, atol=1e-12)
    assert np.allclose(back.diagnostics["quality"], motion.diagnostics["quality"], rtol=1e-5, equal_nan=True)
    assert back.diagnostics["posing_scale"] == pytest.approx(1.25)


def test_the_file_is_what_other_programs_expect(motion: Motion, tmp_path: Path) -> None:
    def refuse(name: str) -> None:
        raise AssertionError(f"{name} is no JSON")

    write_motion(motion, tmp_path / "motion.json")
    value = json.loads((tmp_path / "motion.json").read_text(encoding="utf-8"), parse_constant=refuse)
    assert value["frame_start"] == 101 and value["fps"] == 29.97
    assert value["keyframes"] == [101, 105, 110]
    assert set(value["points"]) == set(value["sigma_m"]) == set(BODY.skeleton.point_names)
    assert set(value["posture"]) == set(BODY.skeleton.dof_names)
    assert np.shape(value["points"]["wrist.L"]) == (FRAMES, 3)
    wrist = BODY.skeleton.point_names.index("wrist.L")
    trace = np.trace(motion.point_covariance[:, wrist], axis1=-2, axis2=-1)
    assert np.allclose(value["sigma_m"]["wrist.L"], np.sqrt(trace), atol=1e-6)
    hips = 0.5 * (np.array(value["points"]["hip.L"]) + np.array(value["points"]["hip.R"]))
    assert np.allclose(value["posture"]["pelvis.location_x"], hips[:, 0], atol=2e-6)


def test_the_same_motion_gives_the_same_bytes(motion: Motion, tmp_path: Path) -> None:
    write_motion(motion, tmp_path / "a.json")
    write_motion(motion, tmp_path / "b.json")
    write_motion(motion, tmp_path / "b.json")
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.json", "b.json"]


def test_without_a_covariance_no_sigma_is_claimed(motion: Motion, tmp_path: Path) -> None:
    unknown = replace(motion, point_covariance=np.full((FRAMES, 13, 3, 3), np.nan))
    write_motion(unknown, tmp_path / "motion.json")
    assert "sigma_m" not in json.loads((tmp_path / "motion.json").read_text(encoding="utf-8"))
    assert np.isnan(read_motion(tmp_path / "motion.json").point_covariance).all()


def test_a_motion_with_gaps_is_not_written(motion: Motion, tmp_path: Path) -> None:
    points = motion.points.copy()
    points[6, 2, 1] = np.nan
    with pytest.raises(ConversionError, match="frame 107"):
        write_motion(replace(motion, points=points), tmp_path / "motion.json")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda v: v.update(schema_version=99), "schema_version is 99"),
        (lambda v: v.pop("time_s"), "time_s is missing"),
        (lambda v: v["time_s"].pop(), "time_s is"),
        (lambda v: v["points"].pop("head"), "head is missing"),
        (lambda v: v["points"]["head"].__setitem__(3, [0, 1]), "points: head is"),
        (lambda v: v["posture"]["elbow.L.flexion"].__setitem__(3, "x"), r"elbow\.L\.flexion is"),
        (lambda v: v.update(keyframes=[300]), r"keyframes is \[300\]"),
        (lambda v: v["actor"]["segments_m"].update(trunk=-1), "trunk is -1"),
        (lambda v: v["diagnostics"].update(quality="good"), "diagnostics: quality is 'good'"),
    ],
)
def test_a_damaged_motion_file_is_named(
    motion: Motion, tmp_path: Path, change: Callable[[dict[str, Any]], object], sentence: str
) -> None:
    path = tmp_path / "motion.json"
    write_motion(motion, path)
    value = json.loads(path.read_text(encoding="utf-8"))
    change(value)
    path.write_text(json.dumps(value), encoding="utf-8")
    with pytest.raises(InputError, match=sentence) as caught:
        read_motion(path)
    assert "motion.json" in str(caught.value)
