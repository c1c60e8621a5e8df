"""The command line with Blender in the process: all files, and standard output free of Blender's messages."""

import json
import os
import subprocess
import sys
from pathlib import Path

import bpy
import pytest
from _command_line import tree
from _synthetic_take import write_synthetic_take
from keymark.operators.cli.main import main

FRAMES = 16
QUICKLY = ("--method", "interpolation", "--no-report", "--quiet")


@pytest.fixture
def take(tmp_path: Path) -> Path:
    return write_synthetic_take(tmp_path / "takes" / "small", FRAMES)


def test_converting_writes_a_scene_that_opens_and_finds_its_clip(take: Path, tmp_path: Path) -> None:
    out = tmp_path / "results" / "out"
    assert main(["convert", str(take), "--output", str(out), "--method", "interpolation", "--quiet"]) == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "motion.blend"))
    armatures = [thing for thing in bpy.data.objects if thing.type == "ARMATURE"]
    assert len(armatures) == 1 and armatures[0].animation_data.action is not None
    (clip,) = bpy.data.movieclips
    assert clip.filepath.startswith("//")
    found = Path(os.path.normpath(bpy.path.abspath(clip.filepath)))
    assert found.parent == take / "frames" and found.is_file()
    assert f"Frames: {FRAMES}" in (out / "motion.bvh").read_text(encoding="utf-8")
    assert sorted(path.name for path in out.parent.iterdir()) == ["out"]


def test_a_folder_filled_from_within_finds_its_clip_as_well(
    take: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "results" / "out"
    out.mkdir(parents=True)
    from keymark.core.files import output_folder

    monkeypatch.setattr(output_folder.os, "access", lambda path, mode: Path(path) == out)
    words = ["convert", str(take), "--output", str(out), *QUICKLY]
    assert main(words) == 0
    made = {".as_made.json", "conversion.json", "motion.blend", "motion.bvh", "motion.json"}
    assert {path.name for path in out.iterdir()} == made
    bpy.ops.wm.open_mainfile(filepath=str(out / "motion.blend"))
    (clip,) = bpy.data.movieclips
    assert Path(os.path.normpath(bpy.path.abspath(clip.filepath))).is_file()


@pytest.mark.skipif(
    bool(bpy.app.binary_path),
    reason="a Blender program's own Python has no bpy; tests/real_blender converts in it",
)
def test_standard_output_is_json_alone(take: Path, tmp_path: Path, repository: Path) -> None:
    links = tmp_path / "links"
    links.mkdir()
    (links / "keymark").symlink_to(repository, target_is_directory=True)
    done = subprocess.run(
        [sys.executable, "-m", "keymark", "convert", str(take), "--output", str(tmp_path / "out"), "--json"],
        env={**os.environ, "PYTHONPATH": str(links)},
        capture_output=True,
        text=True,
        check=True,
    )
    said = json.loads(done.stdout)
    assert said["frames"] == FRAMES and said["method"] == "map"
    assert all(Path(file).is_file() for file in said["files"])
    assert done.stderr == ""


def test_a_scene_that_cannot_be_written_leaves_nothing_behind(
    take: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    from keymark.core.errors import ConversionError
    from keymark.operators.bridge import result_files

    def fail(_armature_object: object, path: Path) -> None:
        os.write(1, b"chatter\n")
        raise ConversionError(f"{path.name}: the exporter failed")

    monkeypatch.setattr(result_files, "write_bvh", fail)
    assert main(["convert", str(take), "--output", str(tmp_path / "out"), *QUICKLY]) == 1
    said = capfd.readouterr()
    assert said.out == "" and "the exporter failed" in said.err and len(said.err.splitlines()) == 1
    assert not (tmp_path / "out").exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["takes"]


@pytest.mark.parametrize("within", [False, True], ids=["staged beside", "staged within"])
@pytest.mark.parametrize("writer", ["write_blend", "write_bvh"])
def test_a_failure_leaves_the_old_files_and_nothing_else(
    take: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, writer: str, within: bool
) -> None:
    from keymark.core.errors import ConversionError
    from keymark.core.files import output_folder
    from keymark.operators.bridge import result_files

    out = tmp_path / "results" / "out"
    words = ["convert", str(take), "--output", str(out), *QUICKLY]
    assert main(words) == 0
    before = tree(out.parent)
    if within:
        monkeypatch.setattr(output_folder.os, "access", lambda path, mode: Path(path) == out)
    written: list[Path] = []

    def fail(first: object, second: object, **_options: object) -> None:
        path = first if isinstance(first, Path) else second
        assert isinstance(path, Path)
        path.write_bytes(b"half")
        written.append(path)
        raise ConversionError("the disk is full")

    monkeypatch.setattr(result_files, writer, fail)
    assert main(words) == 1
    assert len(written) == 1 and (written[0].parent == out) == within
    assert tree(out.parent) == before
