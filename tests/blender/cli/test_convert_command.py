"""The command line with Blender in the process: all files, and standard output free of Blender's messages."""

import json
import os
import subprocess
import sys
from pathlib import Path

import bpy
import pytest
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
