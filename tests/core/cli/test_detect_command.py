"""`keymark detect`: one clip, a take, a shoot; what is written and what not."""

import json
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
from _command_line import one_line, tree
from _drawn_clip import MiddleNetwork
from _synthetic_take import SIZE, edit_json, true_postures, write_shoot, write_synthetic_take, write_video
from keymark.core.detect.keypoint_file import read_keypoints
from keymark.core.take.take_file import read_take
from keymark.operators.cli.main import main

FRAMES = 8


@pytest.fixture(autouse=True)
def network(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that sees somebody in the middle of every picture."""
    monkeypatch.setattr("keymark.operators.cli.commands.detect.PoseNetwork", MiddleNetwork)


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    file = tmp_path / "clips" / "walk.mp4"
    file.parent.mkdir()
    write_video(file, true_postures(FRAMES), seed=1)
    return file


def test_a_bare_clip_gets_its_file_beside_it(clip: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["detect", str(clip)]) == 0
    file = clip.with_name("walk.keypoints.json")
    assert f"a person in 8 of 8 frames: {file}" in capsys.readouterr().out
    assert read_keypoints(file, FRAMES, SIZE, 30.0, 1).most_people == 1
    assert set(tree(clip.parent)) == {"walk.mp4", "walk.keypoints.json"}


def test_a_take_gets_its_file_in_its_folder_with_its_own_frame_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    take = write_synthetic_take(tmp_path / "take", FRAMES)
    edit_json(take / "take.json", frame_start=101)
    assert main(["detect", str(take), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["seen_frames"] == FRAMES and said["keypoints"] == str(take / "keypoints.json")
    written = json.loads((take / "keypoints.json").read_text())
    assert (
        written["frame_start"] == 101 and written["size"] == list(SIZE) and len(written["frames"]) == FRAMES
    )


def test_the_folder_one_is_in_is_named_as_others_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    images = tmp_path / "walk"
    images.mkdir()
    for number in range(3):
        cv2.imwrite(str(images / f"{number:04d}.png"), np.zeros((SIZE[1], SIZE[0], 3), np.uint8))
    monkeypatch.chdir(images)
    assert main(["detect", ".", "--quiet"]) == 0
    assert (tmp_path / "walk.keypoints.json").is_file()


def test_a_file_that_is_there_stays_unless_it_is_to_be_replaced(
    clip: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = clip.with_name("walk.keypoints.json")
    file.write_text("mine")
    assert main(["detect", str(clip), "--quiet"]) == 2
    assert "is there already" in one_line(capsys.readouterr().err) and file.read_text() == "mine"
    other = tmp_path / "other.json"
    assert main(["detect", str(clip), "--output", str(other), "--quiet"]) == 0
    assert other.is_file() and file.read_text() == "mine"
    assert main(["detect", str(clip), "--replace", "--quiet"]) == 0
    assert read_keypoints(file, FRAMES, SIZE).most_people == 1


def test_what_fails_is_one_sentence_and_changes_nothing(
    clip: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(path: Path, said: str, *words: str) -> None:
        assert main(["detect", str(path), *words, "--quiet"]) == 2
        assert said in one_line(capsys.readouterr().err)

    before = clip.read_bytes()
    fails(clip, "cannot be written", "--output", "/nowhere/file.json")
    broken, picture = clip.with_name("broken.mp4"), clip.with_name("portrait.png")
    broken.write_bytes(before[: len(before) // 3])
    fails(broken, "broken.mp4: ")
    cv2.imwrite(str(picture), np.zeros((60, 80, 3), dtype=np.uint8))
    fails(picture, "portrait.png: is a single picture")
    monkeypatch.setattr(MiddleNetwork, "presence", 0.0)
    fails(clip, "walk.mp4: nobody is seen in any of its 8 frames")
    monkeypatch.undo()
    monkeypatch.setattr("keymark.core.detect.pose_network.PoseNetwork.__init__.__defaults__", (clip,))
    fails(clip, "is damaged or another one")
    assert clip.read_bytes() == before and not list(clip.parent.glob("*.json"))


def test_a_shoot_goes_on_after_failures_and_leaves_what_is_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shoot = write_shoot(tmp_path / "shoot", 3, FRAMES)
    day = shoot / "day1"
    (day / "take02.keypoints.json").write_text("mine")
    (day / "take01.mp4").write_bytes(b"no video")
    assert main(["detect", str(shoot), "--json"]) == 1
    said, error = capsys.readouterr()
    assert "1 of 3 takes failed: day1/take01" in one_line(error)
    outcomes = json.loads(said)
    assert (outcomes["detected"], outcomes["there_already"], outcomes["failed"]) == (1, 1, 1)
    assert [take["error"] is None for take in outcomes["takes"]] == [False, True, True]
    assert (day / "take03" / "keypoints.json").is_file()
    assert (day / "take02.keypoints.json").read_text() == "mine"
    assert main(["detect", str(shoot), "--output", "x.json"]) == 2
    assert "--output is one file" in one_line(capsys.readouterr().err)
    assert main(["detect", str(tmp_path / "nowhere")]) == 2


def test_clips_need_no_description(clip: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copyfile(clip, clip.with_name("run.mp4"))
    assert main(["detect", str(clip.parent)]) == 0
    assert "2 takes: 2 detected, 0 there already, 0 failed" in capsys.readouterr().out
    names = {"run.keypoints.json", "run.mp4", "walk.keypoints.json", "walk.mp4"}
    assert set(tree(clip.parent)) == names


def test_a_take_that_names_its_keypoints_gets_them_there(tmp_path: Path) -> None:
    take = write_synthetic_take(tmp_path / "take", FRAMES)
    edit_json(take / "take.json", keypoints="found.json")
    assert main(["detect", str(take), "--quiet"]) == 0
    assert (take / "found.json").is_file() and not (take / "keypoints.json").exists()
    assert len(read_take(take, whole=True).keypoints) == 1


def test_a_network_of_ones_own_that_is_none_is_one_sentence(
    clip: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "net.onnx"
    file.write_bytes(b"PK\x03\x04")
    assert main(["detect", str(clip), "--network", str(file), "--quiet"]) == 2
    assert "net.onnx: is a zip archive; unpack it" in one_line(capsys.readouterr().err)
    assert not clip.with_name("walk.keypoints.json").exists()
