"""`keymark check` of evidence: what a take has, how good its keypoints look, and what is wrong with them."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _synthetic_take import BODY, SIZE, edit_json, true_postures, write_json, write_keypoints, write_shoot
from keymark.core.detect.keypoints import mirrored_point
from keymark.operators.cli.main import main

FRAMES = 10
TAKE = "day1/take01"
KEYPOINTS = f"{TAKE}.keypoints.json"


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A shoot of one take with keypoints, that tests must not change."""
    folder = write_shoot(tmp_path_factory.mktemp("evidence") / "shoot", 1, FRAMES)
    write_keypoints(folder / f"{TAKE}.keypoints.json", true_postures(FRAMES + 1)[:FRAMES])
    return folder


@pytest.fixture
def shoot(pristine: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pristine, tmp_path / "shoot"))


@pytest.fixture
def check(capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, dict[str, Any]]]:
    """Run `keymark check --json`; returns the exit status and what it says of the first take."""

    def run(*words: object) -> tuple[int, dict[str, Any]]:
        status = main(["check", *map(str, words), "--json"])
        return status, json.loads(capsys.readouterr().out)["takes"][0]

    return run


def no_markers(shoot: Path) -> None:
    edit_json(shoot / f"{TAKE}.take.json", markers=None)


def test_good_keypoints_are_said_to_be_good(
    pristine: Path, check: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    status, take = check(pristine)
    assert status == 0 and take["status"] == "ready" and take["warnings"] == []
    assert take["evidence"] == ["markers", "keypoints", "contours"] and len(take["markers"]) == 5
    (readout,) = take["keypoints"]
    assert readout["file"] == "take01.keypoints.json" and readout["source"] == "drawn"
    assert (readout["points"], readout["people"], readout["depth_hints"]) == (13, 1, False)
    assert readout["seen_frames"] == readout["seen_points"] == 1.0 and readout["error_px"] < 0.5
    assert main(["check", str(pristine)]) == 0
    said = capsys.readouterr().out
    assert "keyframes  keypoints  trunk" in said and "  100% 0px  " in said
    assert "Held against markers, keypoints and contours." in said


def test_a_take_without_markers_is_ready(shoot: Path, check: Callable[..., Any]) -> None:
    no_markers(shoot)
    status, take = check(shoot)
    assert status == 0 and take["status"] == "ready"
    assert take["evidence"] == ["keypoints", "contours"] and take["markers"] == {}
    status, take = check(shoot, "--evidence", "contours")
    assert status == 0 and take["status"] == "look" and take["keypoints"] == []
    assert "held against contours alone" in take["warnings"][0]
    status, take = check(shoot, "--evidence", "contours", "--keyframes", "auto")
    assert status == 1 and "neither markers nor keypoints, without which no posture" in take["problems"][0]
    status, take = check(shoot, "--evidence", "markers")
    assert status == 1 and "names markers, which this take has not got" in take["problems"][0]
    edit_json(shoot / f"{TAKE}.take.json", markers=None, method="ekf")
    status, take = check(shoot)
    assert status == 1 and take["problems"][0].startswith("take01: method is ekf")


def exchanged(value: dict[str, Any]) -> None:
    value["names"] = [mirrored_point(name) for name in value["names"]]


def elsewhere(value: dict[str, Any]) -> None:
    value["frames"] = [[[x - 45.0, y, score] for x, y, score in frame] for frame in value["frames"]]


def late(value: dict[str, Any]) -> None:
    value["frames"] = 3 * [value["frames"][0]] + value["frames"][:-3]


def rare(value: dict[str, Any]) -> None:
    value["frames"] = value["frames"][:3] + [None] * (FRAMES - 3)


def half_the_size(value: dict[str, Any]) -> None:
    value["size"] = [side // 2 for side in SIZE]
    value["frames"] = [[[x / 2, y / 2, score] for x, y, score in frame] for frame in value["frames"]]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (exchanged, "left and right seem to be exchanged"),
        (elsewhere, "from those of the posed keyframes, where the performer is"),
        (late, "they seem to be 3 frames late"),
        (rare, "the performer is seen in 30% of the frames only"),
        (half_the_size, "was found in pictures of 80 x 60"),
    ],
)
def test_keypoints_that_look_wrong_are_said(
    shoot: Path, check: Callable[..., Any], change: Callable[[dict[str, Any]], None], sentence: str
) -> None:
    if change is late:  # which is seen in fast movement only
        faster(shoot)
    edit_json(shoot / KEYPOINTS, change)
    status, take = check(shoot)
    assert status == 0 and take["status"] == "look"
    assert any(sentence in warning for warning in take["warnings"]), take["warnings"]


def faster(shoot: Path) -> None:
    """Let the performer of keyframes and keypoints squat and rise; the clip does not matter here."""
    names, vector = BODY.skeleton.dof_names, true_postures(FRAMES).to_vector()
    vector[:, names.index("pelvis.location_x")] = 0.5 * np.sin(np.linspace(0.0, 2.0 * np.pi, FRAMES))
    posture = type(true_postures(2)).from_vector(BODY.skeleton, vector)
    write_keypoints(shoot / f"{TAKE}.keypoints.json", posture)
    rows = [
        {"frame": index + 1, "posture": dict(zip(names, vector[index].tolist(), strict=True))}
        for index in range(0, FRAMES - 3, 2)
    ]
    write_json(shoot / f"{TAKE}.keyframes.json", {"keyframes": rows})
    no_markers(shoot)


def test_two_people_need_a_keyframe(shoot: Path, check: Callable[..., Any]) -> None:
    def doubled(value: dict[str, Any]) -> None:
        other = [[[x / 2, y, score] for x, y, score in frame] for frame in value["frames"]]
        value["people"] = [list(pair) for pair in zip(value.pop("frames"), other, strict=True)]

    edit_json(shoot / KEYPOINTS, doubled)
    status, take = check(shoot)
    assert status == 0 and take["keypoints"][0]["people"] == 2 and take["warnings"] == []
    assert take["keypoints"][0]["error_px"] < 0.5
    (shoot / f"{TAKE}.keyframes.json").unlink()
    take = check(shoot, "--library", "waving")[1]
    assert any("no keyframe says which of them performs" in warning for warning in take["warnings"])


@pytest.mark.parametrize("words", [("--evidence", "sound"), ("--keypoints", "../k.json")])
def test_an_option_that_is_none_is_one_line(
    pristine: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, str]
) -> None:
    assert main(["check", str(pristine), *words]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and words[1] in said
    assert main(["check", str(pristine), f"{words[0]}=", "--quiet"]) == 0
