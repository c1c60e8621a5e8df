"""Both farms' jobs with a real Blender in place of the command `keymark`: what their workers call, called."""

import json
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from _character_glb import write_glb
from _characters import plain_character
from _synthetic_take import write_shoot
from installed_blender import Blender

OPENJD = Path(sys.executable).with_name("openjd.exe" if os.name == "nt" else "openjd")
NODE = shutil.which("node")


@pytest.fixture(scope="module")
def shoot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two tiny takes, whose motions a character gets too."""
    folder = write_shoot(tmp_path_factory.mktemp("shoots") / "walk", 2)
    write_glb(plain_character(root="root"), folder / "anna.glb")
    said = json.loads((folder / "shoot.json").read_text(encoding="utf-8"))
    said["character"] = {"file": "anna.glb", "tolerance_mm": 2}
    (folder / "shoot.json").write_text(json.dumps(said), encoding="utf-8")
    return folder


def whole(output: Path, library: str) -> bool:
    """Whether both takes are converted, with their character, and merged."""
    lines = (output / "summary.jsonl").read_text(encoding="utf-8").splitlines()
    status = {line["take"]: line["status"] for line in map(json.loads, lines)}
    blend = output / "asset_library" / f"{library}.blend"
    characters = [output / take / "character.blend" for take in status]
    return (
        all(file.is_file() for file in characters)
        and status.keys() == {"day1/take01", "day1/take02"}
        and set(status.values()) <= {"converted", "unchanged"}
        and blend.is_file()
    )


@pytest.mark.skipif(NODE is None, reason="there is no Node, in which the job type is compiled")
def test_the_tasks_of_flamenco_run(blender: Blender, repository: Path, shoot: Path, tmp_path: Path) -> None:
    output = tmp_path / "out"
    settings = {
        "shoot": str(shoot),
        "output": str(output),
        "tasks": 2,
        "program": "{blender}",
        "name": "Walk",
    }
    compiled = subprocess.run(
        [
            str(NODE),
            str(repository / "tests" / "farm" / "flamenco_stand_in.js"),
            str(repository / "presets" / "flamenco" / "keymark_convert.js"),
        ],
        input=json.dumps({"name": "A job", "settings": settings}),
        capture_output=True,
        text=True,
        check=True,
    )
    tasks = json.loads(compiled.stdout)["tasks"]
    assert len(tasks) == 3
    for task in tasks:
        for command in task["commands"]:
            assert command["parameters"]["exe"] == "{blender}"
            done = blender.run(*command["parameters"]["args"])
            assert done.returncode == 0, done.stdout + done.stderr
    assert whole(output, "Walk")


@pytest.mark.skipif(not OPENJD.is_file(), reason="openjd-cli is not installed beside this Python")
@pytest.mark.skipif(os.name == "nt", reason="the program that stands for Blender is a shell script")
def test_the_job_of_open_job_description_runs(
    blender: Blender, repository: Path, shoot: Path, tmp_path: Path
) -> None:
    program = tmp_path / "blender"
    setting = f"BLENDER_USER_RESOURCES={shlex.quote(str(blender.user))}"
    program.write_text(f'#!/bin/sh\n{setting} exec {shlex.join(blender.command)} "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    output = tmp_path / "out"
    given = {"Shoot": shoot, "Output": output, "Tasks": 1, "Keymark": program, "Name": "Walk"}
    done = subprocess.run(
        [
            str(OPENJD),
            "run",
            str(repository / "presets" / "openjd" / "keymark_convert.yaml"),
            "--step",
            "Merge",
            "--run-dependencies",
            *(word for name, value in given.items() for word in ("-p", f"{name}={value}")),
        ],
        capture_output=True,
        text=True,
        timeout=900,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert whole(output, "Walk")
