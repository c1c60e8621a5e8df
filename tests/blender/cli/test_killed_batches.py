"""Batches that are killed, lose a worker or run twice at once; a later run completes them."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import bpy
import pytest
from _results import blend_is_of, finished_folders, hidden_files, is_whole, same_in_every_run
from _synthetic_take import write_shoot

pytestmark = [
    pytest.mark.faults,
    pytest.mark.skipif(sys.platform != "linux", reason="workers are looked up in /proc"),
    pytest.mark.skipif(bool(bpy.app.binary_path), reason="a Blender program's own Python has no bpy"),
]
TAKES = 4
DEATHS = 18
TO_ITS_END = 3
"""Number of kills after which a batch runs to its end."""
SEED = 22


@pytest.fixture(scope="module")
def shoot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_shoot(tmp_path_factory.mktemp("shoots") / "shoot", TAKES)


@contextmanager
def batch(shoot: Path, out: Path, *words: str) -> "Iterator[subprocess.Popen[str]]":
    """A batch in a process group of its own, which is killed at the end."""
    script = Path(__file__).resolve().parents[2] / "_dying.py"
    process = subprocess.Popen(
        [sys.executable, str(script), "never", "-", "batch", str(shoot), "--output", str(out), *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    try:
        yield process
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        assert process.stdout is not None
        process.stdout.close()


def to_the_end(shoot: Path, out: Path, *words: str) -> dict[str, bytes | None]:
    """Run a batch to its end; returns everything that is the same in every run."""
    with batch(shoot, out, *words) as process:
        said, _ = process.communicate()
        assert process.returncode == 0, said
    return results(out)


def results(out: Path) -> dict[str, bytes | None]:
    """The files of the takes' folders; the summary is left out, for it has times."""
    assert not hidden_files(out)
    for finished in finished_folders(out):
        assert is_whole(finished) and blend_is_of(finished)
    lines = (out / "summary.jsonl").read_text(encoding="utf-8").splitlines()
    assert len(lines) == TAKES
    assert {json.loads(line)["status"] for line in lines} <= {"converted", "unchanged"}
    kept = ("summary.jsonl", "summary.html", ".keymark", ".keymark/")
    return {name: held for name, held in same_in_every_run(out).items() if not name.startswith(kept)}


def workers(process: "subprocess.Popen[str]") -> list[int]:
    with suppress(OSError):
        text = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text(encoding="ascii")
        return [int(word) for word in text.split()]
    return []


def test_killed_batches_lose_nothing(shoot: Path) -> None:
    chance = random.Random(SEED)
    out = shoot.parent / "results"
    begun = time.monotonic()
    undisturbed = to_the_end(shoot, out, "--jobs", "2")
    lasts_s = time.monotonic() - begun
    assert to_the_end(shoot, out, "--jobs", "1", "--again") == undisturbed
    victims = []
    for death in range(1, DEATHS + 1):
        again = ("--again",) if chance.random() < 0.5 else ()
        victim = chance.choice(["batch", "worker", "all"])
        with batch(shoot, out, "--jobs", "2", *again) as process:
            with suppress(subprocess.TimeoutExpired):
                process.communicate(timeout=chance.uniform(0.2, 0.9) * lasts_s)
            found = workers(process)
            if victim == "all":
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
            elif victim == "batch" or not found:
                process.kill()
            else:
                with suppress(ProcessLookupError):
                    os.kill(chance.choice(found), signal.SIGKILL)
                said, _ = process.communicate()
                assert process.returncode == 0, said  # a lost worker costs its take one retry
            victims.append(victim)
            if victim == "batch" and chance.random() < 0.5:  # its workers live on a little
                assert to_the_end(shoot, out, "--jobs", "2") == undisturbed
        assert all(map(is_whole, finished_folders(out)))
        if death % TO_ITS_END == 0:
            assert to_the_end(shoot, out, "--jobs", str(chance.choice([1, 2, 3]))) == undisturbed
            shutil.rmtree(out)
    assert {"batch", "worker", "all"} == set(victims)


def test_two_batches_on_one_folder_end_well(shoot: Path) -> None:
    out = shoot.parent / "alone"
    undisturbed = to_the_end(shoot, out, "--jobs", "2")
    shutil.rmtree(out)
    with batch(shoot, out, "--jobs", "2") as first, batch(shoot, out, "--jobs", "2") as second:
        for process in (first, second):
            said, _ = process.communicate()
            assert process.returncode == 0, said
    assert results(out) == undisturbed
