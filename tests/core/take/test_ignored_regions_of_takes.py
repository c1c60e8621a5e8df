"""Regions of the picture: those ignored in a take, and those where its markers are expected."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _synthetic_take import SIZE, edit_json, write_json, write_shoot, write_synthetic_take
from keymark.core.errors import InputError
from keymark.core.markers.ignored_regions import MOST_POINTS, MOST_REGIONS, IgnoredRegion
from keymark.core.prior.keyframes import interpolate
from keymark.core.take.read_footage import average_model, expected_regions
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take, write_take

FRAMES = 16
BOX = {"box": [1, 2.5, 30, 40]}
STROKE = {"stroke": [[5, 5], [9.5, 7]], "radius_px": 4, "frames": [11, 13]}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_synthetic_take(tmp_path / "take", FRAMES)


def ignoring(folder: Path, value: Any) -> Path:
    return edit_json(folder / "take.json", ignored_regions=value).parent


def test_a_take_says_what_is_never_a_marker_and_is_written_back(folder: Path, tmp_path: Path) -> None:
    assert read_take(folder).ignored_regions == ()
    edit_json(
        folder / "keyframes.json", lambda v: [row.update(frame=row["frame"] + 10) for row in v["keyframes"]]
    )
    edit_json(folder / "take.json", frame_start=11, ignored_regions=[BOX, STROKE])
    take = read_take(folder)
    assert take.ignored_regions == (
        IgnoredRegion(box=(1.0, 2.5, 30.0, 40.0)),
        IgnoredRegion(stroke=((5.0, 5.0), (9.5, 7.0)), radius_px=4.0, frames=(0, 2)),
    )
    write_take(take, tmp_path / "copy")
    written = json.loads((tmp_path / "copy" / "take.json").read_text(encoding="utf-8"))
    assert written["ignored_regions"] == [BOX, STROKE]
    assert read_take(tmp_path / "copy").ignored_regions == take.ignored_regions


def test_a_take_without_them_is_written_as_ever(folder: Path, tmp_path: Path) -> None:
    write_take(read_take(ignoring(folder, None)), tmp_path / "copy")
    assert "ignored_regions" not in json.loads((tmp_path / "copy" / "take.json").read_text(encoding="utf-8"))


def test_a_shoot_says_it_for_all_its_takes(tmp_path: Path) -> None:
    shoot = write_shoot(tmp_path / "shoot", takes=2, frames=3)
    file = shoot / "shoot.json"
    edit_json(file, ignored_regions=[BOX])
    clips = [shoot / "day1" / f"take0{number}.mp4" for number in (1, 2)]
    write_json(shoot / "day1" / "take02.take.json", {"ignored_regions": None})
    first, second = (read_take(clip, keyframes_required=False) for clip in clips)
    assert [len(take.ignored_regions) for take in (first, second)] == [1, 0]
    edit_json(file, ignored_regions=[{"bx": 1}])
    with pytest.raises(InputError, match=r"shoot.json: ignored_regions\[0\] has the unknown field 'bx'"):
        read_take(clips[0], keyframes_required=False)


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        ({"box": [1, 2, 3, 4]}, "take.json: ignored_regions is .*; it must be a list of at most 200 regions"),
        ([[1, 2, 3, 4]], r"ignored_regions\[0\] is \[1, 2, 3, 4\]; it must be an object"),
        ([BOX, {}], r"ignored_regions\[1\]: box is missing; it must be \[left, top, right, bottom\]"),
        ([{"box": [1, 2, 3]}], r"box is \[1, 2, 3\]; it must be \[left, top, right, bottom\] in pixels"),
        ([{"box": [1, 2, 3, "4"]}], "box is"),
        ([{"box": [3, 2, 1, 4]}], r"box is \[3, 2, 1, 4\], which holds no pixel"),
        ([{"box": [SIZE[0], 0, SIZE[0] + 9, 9]}], "which lies beside the picture of"),
        ([{"stroke": [[1, 1]]}], r"ignored_regions\[0\]: radius_px is missing"),
        ([{"stroke": [], "radius_px": 4}], f"stroke is .*; it must be a list of 1 to {MOST_POINTS} points"),
        ([{"stroke": [[1, 1, 1]], "radius_px": 4}], "stroke is"),
        ([{"stroke": [[1, True]], "radius_px": 4}], "stroke is"),
        ([{"stroke": [[1, 1e300]], "radius_px": 4}], "stroke is"),
        ([{"stroke": [[1, 1]], "radius_px": 0}], "radius_px is 0; it must be a number from 0.5 to"),
        (
            [{**BOX, "stroke": [[1, 1]], "radius_px": 4}],
            "has a box and a stroke; each region has one of them",
        ),
        ([{**BOX, "radius_px": 4}], "has a radius_px without a stroke"),
        (
            [{**BOX, "frames": [4, 2]}],
            r"frames is \[4, 2\]; it must be \[first, last\], scene frames in order",
        ),
        ([{**BOX, "frames": [1.5, 2]}], "frames is"),
        ([{**BOX, "frames": 3}], "frames is 3"),
        ([{**BOX, "frame": [1, 2]}], r"unknown field 'frame' \(is 'frames' meant\?\)"),
        (
            [BOX] * (MOST_REGIONS + 1),
            f"has {MOST_REGIONS + 1} of them; it must be a list of at most {MOST_REGIONS} regions",
        ),
    ],
)
def test_a_mistake_is_one_sentence(folder: Path, value: Any, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence) as error:
        read_take(ignoring(folder, value))
    assert "\n" not in str(error.value) and "take.json" in str(error.value)


FRAMES, AFTER = 60, 11
"""Frames of the clip, and how many of them follow the last keyframe."""


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("expected") / "take", FRAMES - AFTER, 24))


def radius_m(take: Take) -> np.ndarray:
    """(F,) the radius at the performer's distance, alike for all markers [m]."""
    radius = expected_regions(take, FRAMES).radius
    assert radius.shape == (FRAMES, 5) and (np.ptp(radius, axis=1) == 0.0).all()
    prior = interpolate(take.keyframes, FRAMES)
    depth = take.camera.depth(prior.translation, np.arange(FRAMES))
    return np.asarray(radius[:, 0] * depth / take.camera.focal_px)


def test_near_a_keyframe_markers_are_searched_within_0_45_m(take: Take) -> None:
    assert take.keyframe_indices == (0, 24, 48)
    near = [*range(7), *range(18, 31), *range(42, 55)]
    np.testing.assert_allclose(radius_m(take)[near], 0.45, atol=1e-3)


def test_farther_from_it_the_radius_grows_with_a_limb_s_speed(take: Take) -> None:
    found = radius_m(take)
    np.testing.assert_allclose(found[[9, 15]], 0.45 + 3.0 * 0.1, atol=1e-3)
    np.testing.assert_allclose(found[[12, 36]], 0.45 + 3.0 * 0.2, atol=1e-3)
    np.testing.assert_allclose(np.diff(found[54:]), 0.1, atol=1e-3)


def test_time_counts_and_not_frames(take: Take) -> None:
    np.testing.assert_allclose(radius_m(replace(take, fps=60.0))[12], 0.45, atol=1e-3)


def test_markers_are_expected_where_the_interpolated_keyframes_have_them(take: Take) -> None:
    center = expected_regions(take, FRAMES).center
    prior = interpolate(take.keyframes, FRAMES)
    model = average_model(take)
    expected = model.evaluate(take.body.pose(prior), np.arange(FRAMES)).centroid
    assert np.abs(center - expected).max() <= 1.0 / 128.0
    np.testing.assert_array_equal(center[49:], np.broadcast_to(center[48], center[49:].shape))
