"""Batches with real workers: failures, kills and interruptions lead to the same results, byte for byte."""

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import pytest
from _libraries import small_library
from _synthetic_take import true_postures, write_json, write_keypoints, write_shoot
from keymark.core.files.json_file import read_json
from keymark.core.prior.library import write_library
from keymark.core.take.conversion_record import read_record
from keymark.operators.cli.commands import batch as command
from keymark.operators.cli.conversion.blender_files import VARIABLE
from keymark.operators.cli.main import main

TESTS = Path(__file__).resolve().parents[2]
GOOD = ("day1/take01", "day1/take02", "day1/take03")
THIS_TREE = """
import sys
sys.path.insert(0, {tests!r})
from _boot import load_package
load_package()
from keymark.operators.cli.main import main
sys.exit(main(sys.argv[1:]))
"""

pytestmark = pytest.mark.skipif(
    bool(bpy.app.binary_path),
    reason="a Blender program's own Python has no bpy; tests/real_blender runs batches in it",
)


@pytest.fixture(scope="module")
def shoot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three good takes, one that is no video and one whose keyframes are cut off."""
    folder = write_shoot(tmp_path_factory.mktemp("batch") / "shoot", takes=3)
    (folder / "day1" / "text.mp4").write_text("this is no video", encoding="utf-8")
    shutil.copytree(folder / "day1" / "take03", folder / "day2" / "cut off")
    os.truncate(folder / "day2" / "cut off" / "keyframes.json", 40)
    return folder


@pytest.fixture(scope="module")
def results(shoot: Path) -> Path:
    out = shoot.parent / "one"
    assert main(["batch", str(shoot), "--output", str(out), "--jobs", "1", "--quiet"]) == 1
    return out


def tree(folder: Path) -> dict[str, Any]:
    """Every file below a folder but .blend files and those on the run, which differ from run to run."""
    found: dict[str, Any] = {}
    for file in sorted(folder.rglob("*")):
        if file.is_file() and file.suffix != ".blend" and not file.name.startswith(("summary.", ".as_made")):
            found[file.relative_to(folder).as_posix()] = file.read_bytes()
    for name in [name for name in found if name.endswith("conversion.json")]:
        found[name] = json.loads(found[name])
        del found[name]["files"]["motion.blend"]
    return found


def leftovers(folder: Path) -> list[Path]:
    """Unfinished files that a killed process has left."""
    return [path for path in folder.rglob(".*") if path.name not in (".keymark", ".as_made.json")]


def batch(shoot: Path, out: Path, capsys: pytest.CaptureFixture[str], *more: str) -> tuple[int, Any]:
    """Run `keymark batch --json`; returns the exit status and the object."""
    status = main(["batch", str(shoot), "--output", str(out), "--json", *more])
    return status, json.loads(capsys.readouterr().out)


def statuses(said: Any) -> dict[str, str]:
    return {take["take"]: take["status"] for take in said["takes"]}


def test_good_takes_are_converted_and_bad_ones_say_why(results: Path) -> None:
    for name in GOOD:
        record = read_record(results / name)
        assert all((results / name / file).stat().st_size > 0 for file in record.files)
        assert {"motion.json", "motion.blend", "motion.bvh"} <= set(record.files)
    lines = (results / "summary.jsonl").read_text(encoding="utf-8").splitlines()
    errors = {row["take"]: row["error"] for row in map(json.loads, lines)}
    assert list(errors) == [*GOOD, "day1/text", "day2/cut off"]
    assert "text.mp4" in errors["day1/text"] and "keyframes.json: line" in errors["day2/cut off"]
    assert not (results / "day1" / "text").exists() and not (results / "day2").exists()
    assert not leftovers(results)


def test_takes_of_any_clothes_are_converted_beside_others(
    shoot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = tmp_path / "shoot"
    shutil.copytree(shoot / "day1", own / "day1", ignore=shutil.ignore_patterns("text.mp4"))
    said = json.loads((shoot / "shoot.json").read_text(encoding="utf-8"))
    write_json(own / "shoot.json", {**said, "method": "map"})
    for name, fields in {"take01": {}, "take02": {"evidence": ["contours"]}}.items():
        write_json(own / "day1" / f"{name}.take.json", {"markers": None, **fields})
    write_keypoints(own / "day1" / "take01.pose.json", true_postures(8 + 3)[:8])
    status, said = batch(own, tmp_path / "out", capsys, "--jobs", "1", "--keypoints", "pose.json")
    assert status == 1
    assert statuses(said) == {"day1/take01": "converted", "day1/take02": "converted", "day1/take03": "failed"}
    assert "pose.json" in said["takes"][2]["error"]
    write_keypoints(own / "day1" / "take03" / "pose.json", true_postures(8 + 3)[2:10])
    status, said = batch(own, tmp_path / "out", capsys, "--jobs", "1", "--keypoints", "pose.json")
    assert status == 0 and set(statuses(said).values()) == {"unchanged", "converted"}
    assert statuses(said)["day1/take03"] == "converted"


def test_two_workers_give_the_same_bytes_as_one(
    shoot: Path, results: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = shoot.parent / "two"
    status, said = batch(shoot, out, capsys, "--jobs", "2")
    assert status == 1 and said["counts"] == {"converted": 3, "unchanged": 0, "failed": 2, "waiting": 0}
    assert tree(out) == tree(results)


def test_what_is_converted_is_skipped_until_its_input_changes(
    shoot: Path, results: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = Path(shutil.copytree(shoot / "day1", tmp_path / "shoot" / "day1")).parent
    shutil.copyfile(shoot / "shoot.json", own / "shoot.json")
    (own / "day1" / "text.mp4").unlink()
    out = Path(shutil.copytree(results, tmp_path / results.name))
    before = {file: file.stat().st_mtime_ns for file in (out / "day1").rglob("*.json")}
    status, said = batch(own, out, capsys, "--jobs", "1")
    assert status == 0 and statuses(said) == dict.fromkeys(GOOD, "unchanged")
    assert {file: file.stat().st_mtime_ns for file in (out / "day1").rglob("*.json")} == before
    posed = own / "day1" / "take02.keyframes.json"
    value = json.loads(posed.read_text(encoding="utf-8"))
    value["keyframes"] = value["keyframes"][:2]
    posed.write_text(json.dumps(value), encoding="utf-8")
    (out / "day1" / "take03" / "motion.bvh").unlink()
    status, said = batch(own, out, capsys, "--jobs", "1")
    assert status == 0
    assert statuses(said) == dict(zip(GOOD, ("unchanged", "converted", "converted"), strict=True))
    status, said = batch(own, out, capsys, "--jobs", "1", "--again", "--take", GOOD[0])
    assert statuses(said) == {GOOD[0]: "converted"}


@pytest.mark.slow
def test_keyframes_are_found_and_found_again_where_a_library_changes(
    shoot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    own = Path(shutil.copytree(shoot / "day1", tmp_path / "shoot" / "day1")).parent
    shutil.copyfile(shoot / "shoot.json", own / "shoot.json")
    (own / "day1" / "text.mp4").unlink()
    (own / "day1" / "take02.keyframes.json").unlink()
    (tmp_path / "libraries").mkdir()
    monkeypatch.setenv(VARIABLE, str(tmp_path / "libraries"))
    words = ["--jobs", "1", "--take", GOOD[0], "--take", GOOD[1]]
    status, said = batch(own, tmp_path / "out", capsys, *words, "--keyframes", "auto")
    assert status == 0 and statuses(said)[GOOD[1]] == "converted"
    first, second = (read_record(tmp_path / "out" / name) for name in GOOD[:2])
    assert first.library == second.library == "composed" and len(first.libraries) > 1
    assert first.keyframes == (1, 5, 8) and first.matched == ()  # no room is left between posed ones
    assert len(second.keyframes) >= 2 and second.matched == second.keyframes
    write_json(own / "shoot.json", {**read_json(own / "shoot.json"), "keyframes": "auto"})
    status, said = batch(own, tmp_path / "out", capsys, *words)
    assert status == 0 and {statuses(said)[name] for name in GOOD[:2]} == {"unchanged"}
    write_library(tmp_path / "libraries" / "small_steps.json", small_library())
    status, said = batch(own, tmp_path / "out", capsys, *words[:4])
    assert status == 0 and statuses(said)[GOOD[0]] == "converted"
    assert "small_steps" in read_record(tmp_path / "out" / GOOD[0]).libraries


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no signal to one process")
@pytest.mark.slow
def test_an_interrupted_batch_is_whole_and_goes_on(
    shoot: Path, results: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = shoot.parent / "interrupted"
    interrupt(shoot, out, os.killpg, signal.SIGINT)
    interrupt(shoot, out, os.kill, signal.SIGTERM)
    status, said = batch(shoot, out, capsys, "--jobs", "1")
    assert status == 1 and said["counts"]["failed"] == 2
    assert tree(out) == tree(results)


def interrupt(shoot: Path, out: Path, send: Callable[[int, int], None], how: int) -> None:
    """Interrupt a batch at its first take: status 130, one line, no process left and nothing half-written."""
    process = subprocess.Popen(
        [sys.executable, "-c", THIS_TREE.format(tests=str(TESTS)), "batch", str(shoot), "--output", str(out)]
        + ["--jobs", "2"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    first = process.stdout.readline()
    send(process.pid, how)
    _, wrong = process.communicate()
    assert first.startswith("[1/5]") and process.returncode == 130
    (line,) = wrong.splitlines()
    assert "of 5 takes are converted" in line
    with pytest.raises(ProcessLookupError):
        os.killpg(process.pid, 0)
    assert not leftovers(out)


def test_workers_end_when_their_batch_does(shoot: Path, tmp_path: Path) -> None:
    words = [*command.worker_command_line()]
    worker = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert worker.stdin is not None and worker.stdout is not None
    assert b"step" in worker.stdout.readline()
    from keymark.core.shoot.discovery import find_takes
    from keymark.core.take.conversion_settings import NO_SETTINGS
    from keymark.operators.cli.batch.worker_process import Job

    take = find_takes(shoot).takes[0]
    worker.stdout.close()
    worker.stdin.write(Job(take, tmp_path / "out", NO_SETTINGS).to_line())
    worker.stdin.flush()
    assert worker.wait() == 130
    worker.stdin.close()
    assert worker.stderr is not None
    worker.stderr.close()
    assert list(tmp_path.iterdir()) == []
