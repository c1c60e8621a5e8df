"""`keymark new`: fields known from the clips are filled in, others left null; no file is replaced."""

import json
import re
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from _synthetic_take import (
    BODY,
    drawn_frames,
    shoot_fields,
    true_postures,
    write_frames,
    write_keyframes,
    write_keypoints,
    write_shoot,
)
from keymark.core.take.motion import read_motion
from keymark.operators.cli.main import main

FRAMES = 8
PLACED = {"height_m": 1.0, "tilt_deg": 0.0, "distance_m": 4.0}
"""The camera of the synthetic takes, without a matrix."""


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A shoot without `shoot.json`, one take described; tests must not change it."""
    folder = write_shoot(tmp_path_factory.mktemp("new") / "shoot", 3, FRAMES)
    (folder / "shoot.json").unlink()
    return folder


@pytest.fixture
def folder(pristine: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pristine, tmp_path / "shoot"))


def new(*words: object) -> int:
    return main(["new", *map(str, words)])


def written(folder: Path) -> dict[str, Any]:
    value: dict[str, Any] = json.loads((folder / "shoot.json").read_text(encoding="utf-8"))
    return value


def fill_in(folder: Path) -> None:
    fields, known = written(folder), shoot_fields()
    fields["camera"] |= PLACED | {"lens_mm": 40.0}
    for name, marker in fields["markers"].items():
        if marker == {"color_srgb": None}:
            marker |= known["markers"][name]
    fields["actor"] |= known["actor"]
    fields |= {"method": "interpolation", "pictures": False}
    (folder / "shoot.json").write_text(json.dumps(fields), encoding="utf-8")


@pytest.mark.usefixtures("no_blender")
def test_from_clips_to_motions(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert new(folder) == 0
    said = capsys.readouterr().out
    open_fields = re.findall(r"^  (\S+)$", said, flags=re.MULTILINE)
    assert len(open_fields) == 8 and open_fields[:2] == ["camera.height_m", "camera.tilt_deg"]
    assert "the lens, which is a guess" in said
    assert main(["check", str(folder)]) == 1
    said = capsys.readouterr().out
    assert said.count("still to be filled in") == 8 and said.count("\nfails") == 3
    for field in open_fields:
        assert said.count(f"{field.rpartition('.')[2]} is still to be filled in") >= 1
    fill_in(folder)
    assert main(["check", str(folder)]) == 0
    assert capsys.readouterr().out.count("\nready") == 3
    clip = folder / "day1" / "take01.mp4"
    assert main(["convert", str(clip), "--output", str(tmp_path / "out"), "--quiet"]) == 0
    assert len(read_motion(tmp_path / "out" / "motion.json").points) == FRAMES


def test_what_clips_share_is_filled_in(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own = (folder / "day1" / "take03" / "take.json").read_bytes()
    assert new(folder, "--json") == 0
    said = json.loads(capsys.readouterr().out)
    assert said["clips"] == 2 and said["described"] == ["day1/take03"] and said["unreadable"] == []
    assert said["file"] == str(folder / "shoot.json") and len(said["fill_in"]) == 8
    fields = written(folder)
    assert fields["fps"] == 30 and fields["camera"]["resolution"] == [160, 120] and fields["root"] is True
    assert "keyframes" not in fields and any("day1/take03" in line for line in fields["//clips"])
    assert (folder / "day1" / "take03" / "take.json").read_bytes() == own
    assert any(line.startswith("red [2") for line in fields["markers"]["//seen"])
    layout = (folder / "shoot.json").read_text(encoding="utf-8").splitlines()
    assert max(map(len, layout)) <= 120 and len(layout) > 30


def test_where_clips_differ_they_tell_themselves(
    folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    larger = [image.repeat(2, axis=0).repeat(2, axis=1) for image in drawn_frames(true_postures(3))]
    write_frames(folder / "larger.mp4", larger)
    (folder / "text.mp4").write_text("no video", encoding="utf-8")
    assert new(folder, "--output", tmp_path / "other" / "mine.json") == 0
    assert "text.mp4" in capsys.readouterr().out and not (folder / "shoot.json").exists()
    (tmp_path / "other" / "mine.json").rename(folder / "shoot.json")
    fields = written(folder)
    assert "resolution" not in fields["camera"] and fields["fps"] == 30
    lines = fields["//clips"]
    assert any("320 x 240 pixels: larger" in line for line in lines)
    assert any("text.mp4" in line and line.startswith("cannot be read") for line in lines)
    assert fields["keyframes"] == "auto" and fields["floor_m"] == 0.0


def gray(images: Iterable[np.ndarray]) -> list[np.ndarray]:
    return [cv2.cvtColor(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), cv2.COLOR_GRAY2BGR) for image in images]


def test_what_a_motion_can_be_held_against_is_said_of_each_clip(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_frames(folder / "plain.mp4", gray(drawn_frames(true_postures(FRAMES))))
    write_frames(folder / "seen.mp4", gray(drawn_frames(true_postures(FRAMES))))
    write_keypoints(folder / "seen.keypoints.json", true_postures(FRAMES))
    write_keypoints(folder / "day1" / "take01.keypoints.json", true_postures(FRAMES))
    assert new(folder, "--json") == 0
    evidence = json.loads(capsys.readouterr().out)["evidence"]
    assert evidence["plain"] == [] and evidence["seen"] == ["keypoints"]
    assert evidence["day1/take01"] == ["markers", "keypoints"] and evidence["day1/take02"] == ["markers"]
    fields = written(folder)
    assert len(fields["markers"]) == 7 and any('"markers": null' in line for line in fields["markers"]["//"])
    (plain,) = (line for line in fields["//evidence"] if "(plain)" in line)
    assert "no garments in strong colors" in plain and "keymark detect" in plain and "contours" in plain


def test_a_shoot_of_plain_clothes_is_asked_for_no_marker(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "plain"
    folder.mkdir()
    posture = true_postures(FRAMES)
    write_frames(folder / "one.mp4", gray(drawn_frames(posture)))
    write_keyframes(folder / "one.keyframes.json", BODY.points(BODY.pose(posture)), 4)
    write_keypoints(folder / "one.keypoints.json", posture)
    assert new(folder) == 0
    said = capsys.readouterr().out
    left_open = re.findall(r"^  (\S+)$", said, flags=re.MULTILINE)
    assert left_open == ["camera.height_m", "camera.tilt_deg", "actor.height_m"]
    fields, known = written(folder), shoot_fields()
    assert "markers" not in fields and "strong colors" in fields["//markers"][0]
    fields["camera"] |= {"lens_mm": 40.0, "matrix_world": known["camera"]["matrix_world"]}
    fields["actor"] |= known["actor"]
    (folder / "shoot.json").write_text(json.dumps(fields), encoding="utf-8")
    assert main(["check", str(folder)]) == 0
    said = capsys.readouterr().out
    assert "Held against keypoints and contours." in said and "\nready  one" in said


def test_images_alone_cannot_tell_their_rate(folder: Path) -> None:
    below = folder / "day1" / "take03"
    (below / "take.json").unlink()
    (folder / "shoot.json").write_text("{}", encoding="utf-8")
    assert new(below) == 0
    fields = written(below)
    assert fields["fps"] is None and "//fps" in fields and "root" not in fields


def test_no_file_is_replaced_and_a_folder_without_clips_is_refused(
    folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (folder / "shoot.json").write_text("mine", encoding="utf-8")
    empty, taken = tmp_path / "empty", folder / "day1" / "take03"
    empty.mkdir()
    for place, sentence in (
        (folder, "never replaced"),
        (taken, "take.json of its own"),
        (empty, "holds no clip; a clip is a video"),
        (tmp_path / "none", "no such folder"),
    ):
        assert new(place) == 2
        error = capsys.readouterr().err
        assert sentence in error and str(place) in error and len(error.splitlines()) == 1
    assert (folder / "shoot.json").read_text(encoding="utf-8") == "mine" and list(empty.iterdir()) == []
