"""`keymark convert` and `propose` with keypoints and without markers."""

import json
import shutil
from pathlib import Path

import pytest
from _command_line import one_line
from _synthetic_take import edit_json, true_postures, write_json, write_keypoints, write_synthetic_take
from keymark.core.take.motion import read_motion
from keymark.operators.cli.main import main

FRAMES = 16


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A take without markers, with a file of keypoints that it does not name; tests must not change it."""
    folder = write_synthetic_take(tmp_path_factory.mktemp("plain") / "plain", FRAMES)
    take = json.loads((folder / "take.json").read_text(encoding="utf-8"))
    del take["markers"]
    write_json(folder / "take.json", take)
    write_keypoints(folder / "pose.json", true_postures(FRAMES))
    return folder


@pytest.fixture
def take(pristine: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pristine, tmp_path / "take"))


@pytest.mark.usefixtures("no_blender")
def test_any_clothes_convert(pristine: Path, tmp_path: Path) -> None:
    words: dict[str, list[str]] = {
        "contours": [],
        "keypoints": ["--keypoints", str(pristine / "pose.json"), "--evidence", "keypoints"],
    }
    for name, more in words.items():
        out = tmp_path / name
        assert main(["convert", str(pristine), "--output", str(out), "--no-report", "--quiet", *more]) == 0
        assert len(read_motion(out / "motion.json").points) == FRAMES
    digests = {json.loads((tmp_path / name / "conversion.json").read_bytes())["digest"] for name in words}
    assert len(digests) == 2


@pytest.mark.usefixtures("no_blender")
def test_keypoints_that_are_wrong_change_nothing(
    take: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["convert", str(take), "--output", str(out), "--no-report", "--quiet"]) == 0
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    whole = (take / "pose.json").read_bytes()
    value = json.loads(whole)
    for content in (
        whole[: len(whole) // 2],
        whole.replace(b"0.9", b"NaN", 1),
        json.dumps({**value, "layout": "coco19"}).encode(),
        json.dumps({**value, "size": [120, 160]}).encode(),
        json.dumps({**value, "frames": value["frames"] * 2}).encode(),
        json.dumps({**value, "fps": 15, "frames": value["frames"][::2]}).encode(),
        json.dumps({**value, "frames": []}).encode(),
        json.dumps({**value, "frames": [None] * FRAMES}).encode(),
    ):
        (take / "keypoints.json").write_bytes(content)
        assert main(["convert", str(take), "--output", str(out), "--no-report", "--quiet"]) == 2
        assert "keypoints.json: " in one_line(capsys.readouterr().err)
    edit_json(take / "take.json", keypoints="../pose.json")
    assert main(["convert", str(take), "--output", str(out), "--no-report", "--quiet"]) == 2
    assert "inside the take's folder" in one_line(capsys.readouterr().err)
    assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == before


@pytest.mark.usefixtures("no_blender")
def test_a_folder_with_holes_is_noted(take: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    holes = take / "openpose"
    holes.mkdir()
    person = {"pose_keypoints_2d": [80.0, 60.0, 0.9] * 25}
    for frame in range(0, FRAMES, 5):
        write_json(holes / f"clip_{frame:012d}_keypoints.json", {"version": 1.3, "people": [person]})
    edit_json(take / "take.json", keypoints="openpose")
    assert main(["convert", str(take), "--output", str(tmp_path / "out"), "--no-report", "--json"]) == 0
    notes = json.loads(capsys.readouterr().out)["notes"]
    assert any("openpose: lacks 12 of 16 frames" in note for note in notes), notes


@pytest.mark.parametrize("more", [[], ["--keypoints", "{take}/pose.json"]])
def test_frames_are_proposed_from_any_evidence(
    pristine: Path, capsys: pytest.CaptureFixture[str], more: list[str]
) -> None:
    words = [word.format(take=pristine) for word in more]
    assert main(["propose", str(pristine), "--count", "5", "--json", *words]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["frames"][0] == 1 and said["frames"][-1] == FRAMES and len(said["frames"]) == 5
    assert max(said["speed_px_per_frame"]) > 0.0
    assert bool(said["notes"]) != bool(more)
