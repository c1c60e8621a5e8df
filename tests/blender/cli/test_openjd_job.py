"""The Open Job Description template, checked and run for real with its reference command line."""

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

import bpy
import pytest
from _synthetic_take import write_shoot
from keymark.operators.cli.main import main

OPENJD = Path(sys.executable).with_name("openjd.exe" if os.name == "nt" else "openjd")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not OPENJD.is_file(), reason="openjd-cli is not installed beside this Python"),
    pytest.mark.skipif(bool(bpy.app.binary_path), reason="a Blender program's own Python has no bpy"),
]

TAKES = 3
NAMES = [f"day1/take{number:02d}" for number in range(1, TAKES + 1)]


@pytest.fixture(scope="module")
def template(repository: Path) -> Path:
    return repository / "presets" / "openjd" / "keymark_convert.yaml"


@pytest.fixture(scope="module")
def keymark(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that is the command line of this very tree."""
    folder = tmp_path_factory.mktemp("program")
    (folder / "links").mkdir()
    (folder / "links" / "keymark").symlink_to(repository, target_is_directory=True)
    if os.name == "nt":
        program = folder / "keymark.cmd"
        program.write_text(
            f'@set "PYTHONPATH={folder / "links"}"\n@"{sys.executable}" -m keymark %*\n', encoding="utf-8"
        )
    else:
        program = folder / "keymark"
        setting = f"PYTHONPATH={shlex.quote(str(folder / 'links'))}"
        program.write_text(
            f'#!/bin/sh\n{setting} exec {shlex.quote(sys.executable)} -m keymark "$@"\n', encoding="utf-8"
        )
        program.chmod(0o755)
    return program


@pytest.fixture(scope="module")
def shoot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_shoot(tmp_path_factory.mktemp("shoots") / "walk", TAKES)


def openjd(*words: object) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [str(OPENJD), *map(str, words)], capture_output=True, text=True, encoding="utf-8", timeout=600
    )


def parameters(keymark: Path, shoot: Path, output: Path, tasks: int = TAKES, **more: str) -> list[str]:
    given = {"Shoot": shoot, "Output": output, "Tasks": tasks, "Keymark": keymark, "Name": "Walk", **more}
    return [word for name, value in given.items() for word in ("-p", f"{name}={value}")]


def test_the_template_is_valid_without_extensions(template: Path) -> None:
    done = openjd("check", template, "--extensions", "")
    assert done.returncode == 0, done.stdout + done.stderr
    words = ("-p", "Shoot=/shoot", "-p", "Output=/out", "-p", "Tasks=12", "--output", "json")
    summary = json.loads(openjd("summary", template, *words).stdout)
    assert summary["total_steps"] == 2 and summary["total_tasks"] == 13


@pytest.mark.parametrize("wrong", ["Tasks=0", "Tasks=many", "Method=best", "FailedTakes=maybe", "Name="])
def test_unusable_parameters_are_refused(template: Path, wrong: str) -> None:
    words = ("-p", "Shoot=/shoot", "-p", "Output=/out", "-p", "Tasks=1", "-p", wrong)
    done = openjd("summary", template, *words)
    assert done.returncode != 0 and wrong.partition("=")[0] in done.stdout + done.stderr


def test_the_job_gives_what_a_batch_gives(template: Path, keymark: Path, shoot: Path, tmp_path: Path) -> None:
    farm, alone = tmp_path / "farm", tmp_path / "alone"
    step = ("--step", "Merge", "--run-dependencies")
    done = openjd("run", template, *step, *parameters(keymark, shoot, farm, tasks=2))
    assert done.returncode == 0, done.stdout + done.stderr
    assert main(["batch", str(shoot), "--output", str(alone), "--jobs", "1", "--quiet"]) == 0
    for name in NAMES:
        for file in ("motion.json", "motion.bvh"):
            assert (farm / name / file).read_bytes() == (alone / name / file).read_bytes()
        records = [json.loads((out / name / "conversion.json").read_text("utf-8")) for out in (farm, alone)]
        assert records[0]["digest"] == records[1]["digest"]
    lines = [(out / "summary.jsonl").read_text("utf-8").splitlines() for out in (farm, alone)]
    assert [[json.loads(line)["take"] for line in table] for table in lines] == [NAMES, NAMES]
    with bpy.data.libraries.load(str(farm / "asset_library" / "Walk.blend"), assets_only=True) as (found, _):
        assert sorted(found.actions) == ["day1 take01", "day1 take02", "day1 take03"]
    catalogs = (farm / "asset_library" / "blender_assets.cats.txt").read_text("utf-8")
    assert ":Keymark/Walk/day1:" in catalogs


def test_a_task_converts_its_share_and_nothing_else(
    template: Path, keymark: Path, shoot: Path, tmp_path: Path
) -> None:
    output = tmp_path / "out"
    words = ("--step", "Convert", "-tp", "Task=2")
    done = openjd("run", template, *words, *parameters(keymark, shoot, output, tasks=2))
    assert done.returncode == 0, done.stdout + done.stderr
    assert "openjd_status: 1 of 1 take" in done.stdout and "openjd_progress: 100" in done.stdout
    assert [name for name in NAMES if (output / name).exists()] == ["day1/take02"]
    words = ("--step", "Convert", "-tp", "Task=5")
    done = openjd("run", template, *words, *parameters(keymark, shoot, output, tasks=5))
    assert done.returncode == 0, done.stdout + done.stderr
    assert [name for name in NAMES if (output / name).exists()] == ["day1/take02"]


def test_a_failed_take_stops_the_others_only_if_that_is_wanted(
    template: Path, keymark: Path, tmp_path: Path
) -> None:
    shoot = write_shoot(tmp_path / "shoot", 2)
    (shoot / "day1" / "take02.mp4").write_bytes(b"no video")
    output = tmp_path / "out"
    chosen = parameters(keymark, shoot, output, 1, FailedTakes="pass")
    done = openjd("run", template, "--step", "Merge", "--run-dependencies", *chosen)
    assert done.returncode != 0 and "day1/take02" in done.stdout
    with bpy.data.libraries.load(str(output / "asset_library" / "Walk.blend"), assets_only=True) as (
        found,
        _,
    ):
        assert list(found.actions) == ["day1 take01"]
    chosen = parameters(keymark, shoot, tmp_path / "strict", 2, FailedTakes="fail")
    done = openjd("run", template, "--step", "Convert", "-tp", "Task=2", *chosen)
    assert done.returncode != 0
