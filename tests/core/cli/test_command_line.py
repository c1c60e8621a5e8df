"""The command line: exit status, output, and no traces of a failing run."""

import json
import os
import re
import shutil
import tomllib
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from _command_line import one_line, tree
from _synthetic_take import SIZE, edit_json, write_json, write_synthetic_take
from keymark.core.errors import ConversionError
from keymark.core.session.result import RESULT_FILES
from keymark.core.take.conversion_record import EARLIER_PICTURES
from keymark.core.take.motion import read_motion
from keymark.operators.cli import console as usage
from keymark.operators.cli.commands import SUMMARIES
from keymark.operators.cli.conversion import convert_take
from keymark.operators.cli.main import main

FRAMES = 16
FAST = ("--method", "interpolation", "--no-report")


@pytest.fixture
def take(tmp_path: Path) -> Path:
    return write_synthetic_take(tmp_path / "take", FRAMES)


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """An output folder with an earlier result and a file of the user's."""
    folder = tmp_path / "results" / "out"
    folder.mkdir(parents=True)
    (folder / "motion.json").write_text("earlier", encoding="utf-8")
    (folder / "mine.txt").write_text("mine", encoding="utf-8")
    return folder


def convert(take: Path, out: Path, *more: str) -> int:
    return main(["convert", str(take), "--output", str(out), *more])


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "arguments are required: COMMAND"),
        (["bogus"], "bogus"),
        (["convert"], "TAKE"),
        (["convert", "somewhere"], "--output"),
        (["convert", "a", "b", "--output", "c"], "unrecognized arguments: b"),
        (["convert", "a", "--output", "c", "--method", "magic"], "magic.*map.*ekf"),
        (["convert", "a", "--output", "c", "--bogus"], "--bogus"),
        (["propose", "a", "--count", "many"], "many"),
        (["convert", "no/such/take", "--output", "c"], "no/such/take"),
    ],
)
def test_an_unusable_command_line_is_one_line_and_status_two(
    words: list[str],
    sentence: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([*words, "--quiet"] if words[:1] == ["convert"] else words) == 2
    said = capsys.readouterr()
    assert re.search(sentence, one_line(said.err)) and said.out == ""
    assert list(tmp_path.iterdir()) == []


def test_help_has_examples_and_version_is_the_manifests(
    capsys: pytest.CaptureFixture[str], repository: Path
) -> None:
    assert main(["--help"]) == 0
    assert "convert takes/walk --output out/walk" in capsys.readouterr().out
    assert main(["--version"]) == 0
    manifest = tomllib.loads((repository / "blender_manifest.toml").read_text(encoding="utf-8"))
    assert capsys.readouterr().out == f"keymark {manifest['version']}\n"


def test_every_file_of_a_command_is_on_the_list(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = {path.stem for path in (repository / "operators" / "cli" / "commands").glob("*.py")}
    assert files - {"__init__"} == set(SUMMARIES)
    shown = list(SUMMARIES)
    for name in shown:
        module = import_module(f"keymark.operators.cli.commands.{name}")
        assert hasattr(module, f"{name}_command")
    assert main(["--help"]) == 0
    helped = capsys.readouterr().out
    assert all(re.search(rf"\n    {name}\s", helped) for name in shown) and "\n    worker" not in helped


CHARACTER_FILES = ("character.blend", "retarget.json", "report/character.png")
"""Of takes that name a character."""


@pytest.mark.usefixtures("no_blender")
def test_a_conversion_writes_its_files_and_says_so(
    take: Path, out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert convert(take, out, "--method", "interpolation") == 0
    said = capsys.readouterr()
    assert said.err == ""
    earlier = {f"report/{name}" for name in EARLIER_PICTURES}
    for name in set(RESULT_FILES) - {*earlier, *CHARACTER_FILES}:
        assert (out / name).is_file() and str(out / name) in said.out
    motion = read_motion(out / "motion.json")
    assert len(motion.points) == FRAMES and motion.method == "interpolation"
    assert (out / "mine.txt").read_text(encoding="utf-8") == "mine"
    assert sorted(path.name for path in out.parent.iterdir()) == ["out"]


@pytest.mark.usefixtures("no_blender")
def test_json_is_one_object_and_quiet_is_silence(
    take: Path, out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert convert(take, out, *FAST, "--json") == 0
    said = json.loads(capsys.readouterr().out)
    assert said["frames"] == FRAMES and said["keyframes"][0] == 1 and said["notes"] == []
    assert all(Path(file).is_file() for file in said["files"]) and len(said["files"]) == 4
    assert said["seconds"]["total"] >= said["seconds"]["Following the markers"] > 0.0
    assert convert(take, out, *FAST, "--quiet") == 0
    assert capsys.readouterr() == ("", "")


@pytest.mark.usefixtures("no_blender")
def test_a_second_run_without_pictures_leaves_no_old_pictures(take: Path, out: Path) -> None:
    assert convert(take, out, "--method", "interpolation", "--quiet") == 0
    first = (out / "motion.json").read_bytes()
    assert convert(take, out, *FAST, "--quiet") == 0
    assert not (out / "report").exists()
    assert (out / "motion.json").read_bytes() == first


@pytest.mark.usefixtures("no_blender")
def test_another_keyframe_file_may_be_named(take: Path, tmp_path: Path) -> None:
    value = json.loads((take / "keyframes.json").read_text(encoding="utf-8"))
    value["keyframes"] = value["keyframes"][::2]
    write_json(tmp_path / "fewer.json", value)
    (take / "keyframes.json").unlink()
    new = tmp_path / "new"
    assert convert(take, new, *FAST, "--quiet", "--keyframes", str(tmp_path / "fewer.json")) == 0
    assert len(read_motion(new / "motion.json").keyframe_indices) == len(value["keyframes"])


def edit(name: str, change: Callable[[Any], object]) -> Callable[[Path], object]:
    return lambda take: edit_json(take / name, change)


def cut(name: str) -> Callable[[Path], None]:
    return lambda take: os.truncate(take / name, (take / name).stat().st_size // 2)


def no_video(take: Path) -> None:
    (take / "clip.mp4").write_bytes(b"this is no video" * 50)
    edit("take.json", lambda v: v.update(clip="clip.mp4"))(take)


def no_marker(take: Path) -> None:
    for file in (take / "frames").iterdir():
        cv2.imwrite(str(file), np.full((SIZE[1], SIZE[0], 3), 128, dtype=np.uint8))


def turn_camera_away(value: dict[str, Any]) -> None:
    """Half a turn about the camera's own vertical, away from the performer."""
    for row in value["camera"]["matrix_world"]:
        row[0], row[2] = -row[0], -row[2]


DAMAGES: dict[str, tuple[Callable[[Path], Any], str]] = {
    "no take.json": (lambda take: (take / "take.json").unlink(), "take.json: no such file"),
    "no keyframes": (lambda take: (take / "keyframes.json").unlink(), "keyframes.json: no such file"),
    "no clip": (lambda take: shutil.rmtree(take / "frames"), "frames: no such file"),
    "empty clip folder": (lambda take: [f.unlink() for f in (take / "frames").iterdir()], "holds no image"),
    "clip is no video": (no_video, "clip.mp4"),
    "take.json cut off": (cut("take.json"), "take.json: line"),
    "keyframes.json cut off": (cut("keyframes.json"), "keyframes.json: line"),
    "keyframe outside": (edit("keyframes.json", lambda v: v["keyframes"][0].update(frame=99)), "frame is 99"),
    "frame_count": (edit("take.json", lambda v: v.update(frame_count=99)), "frame_count is 99"),
    "camera turned away": (
        edit("take.json", turn_camera_away),
        "keyframe 1 has the point .* behind the camera",
    ),
    "colors not there": (no_marker, "color"),
}


@pytest.mark.usefixtures("no_blender")
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_take_is_one_line_and_status_two(
    damage: str, take: Path, out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    apply, sentence = DAMAGES[damage]
    apply(take)
    before = tree(out.parent)
    assert convert(take, out, *FAST, "--quiet") == 2
    said = capsys.readouterr()
    assert re.search(sentence, one_line(said.err)) and "Traceback" not in said.err and said.out == ""
    assert tree(out.parent) == before


@pytest.mark.usefixtures("no_blender")
@pytest.mark.parametrize(
    ("problem", "status", "sentence"),
    [
        (ConversionError("the disk\nis full"), 1, "the disk is full"),
        (RuntimeError("something odd"), 1, "RuntimeError: something odd"),
        (MemoryError(), 1, "MemoryError"),
        (ModuleNotFoundError("No module named 'bpy'", name="bpy"), 1, "bpy"),
        (KeyboardInterrupt(), 130, "interrupted"),
    ],
    ids=["conversion", "unexpected", "memory", "module", "interrupted"],
)
def test_a_failing_conversion_is_one_line_and_leaves_nothing_behind(
    problem: BaseException,
    status: int,
    sentence: str,
    take: Path,
    out: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(_take: object, _motion: object, staging_folder: Path, *_rest: object) -> None:
        assert (staging_folder / "motion.json").is_file()
        (staging_folder / "motion.blend").write_bytes(b"half a file")
        raise problem

    monkeypatch.setattr(convert_take, "write_blender_files", fail)
    before = tree(out.parent)
    assert convert(take, out, *FAST, "--quiet") == status
    assert sentence in one_line(capsys.readouterr().err)
    assert tree(out.parent) == before


@pytest.mark.usefixtures("no_blender")
def test_debug_shows_where(
    take: Path, out: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_rest: object) -> None:
        raise RuntimeError("something odd")

    monkeypatch.setattr(convert_take, "write_blender_files", fail)
    assert convert(take, out, *FAST, "--quiet", "--debug") == 1
    lines = capsys.readouterr().err.splitlines()
    assert lines[0].startswith("Traceback") and "something odd" in lines[-1]


def test_without_blender_one_sentence_says_what_to_install(
    take: Path, out: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(usage.importlib.util, "find_spec", lambda name: None)
    before = tree(out.parent)
    assert convert(take, out, "--quiet") == 1
    assert "pip install 'keymark[blender]'" in one_line(capsys.readouterr().err)
    assert tree(out.parent) == before


def test_odd_names_do_not_break_the_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert convert(tmp_path / "two\nlines", tmp_path / "out", "--quiet") == 2
    assert "two lines" in one_line(capsys.readouterr().err)
    assert convert(tmp_path / "odd\udcff", tmp_path / "out", "--quiet") == 2
    assert "odd" in one_line(capsys.readouterr().err)


def test_proposed_frames_lie_in_the_clip(take: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (take / "keyframes.json").unlink()
    assert main(["propose", str(take), "--count", "4", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert len(said["frames"]) == 4 and said["frames"][0] == 1 and said["frames"][-1] == FRAMES
    assert len(said["speed_px_per_frame"]) == FRAMES
    (note,) = said["notes"]
    assert "no keyframe is posed yet" in note and "--keyframes auto" in note
    assert main(["propose", str(take), "--count", "1"]) == 2
    assert "keyframe count is 1" in one_line(capsys.readouterr().err)
