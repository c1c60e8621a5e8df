"""A batch with stand-in workers: job queue, retries, output, exit status, interruption."""

import json
import os
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from keymark.core.shoot.outcomes import read_failure
from keymark.operators.cli.batch import worker_pool
from keymark.operators.cli.batch.outcomes import share_done
from keymark.operators.cli.commands import batch as command
from keymark.operators.cli.console import program_name
from keymark.operators.cli.main import main

STAND_IN = Path(__file__).resolve().parents[2] / "_stand_in_worker.py"


class Studio:
    """A shoot of empty takes with stand-in workers."""

    def __init__(self, folder: Path) -> None:
        self.shoot, self.out, self.log = folder / "shoot", folder / "out", folder / "worker.log"

    def takes(self, *names: str) -> None:
        for name in names:
            (self.shoot / name).mkdir(parents=True)
            (self.shoot / name / "take.json").write_text("{}", encoding="utf-8")

    def batch(self, *words: str, jobs: int = 2) -> int:
        return main(["batch", str(self.shoot), "--output", str(self.out), "--jobs", str(jobs), *words])

    @property
    def received_jobs(self) -> list[dict[str, Any]]:
        if not self.log.exists():
            return []
        return [json.loads(line) for line in self.log.read_text(encoding="utf-8").splitlines()]

    @property
    def summary(self) -> dict[str, dict[str, Any]]:
        lines = (self.out / "summary.jsonl").read_text(encoding="utf-8").splitlines()
        return {row["take"]: row for row in map(json.loads, lines)}


@pytest.fixture
def studio(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Studio:
    made = Studio(tmp_path)
    monkeypatch.setattr(command, "require_blender", lambda needing: None)
    monkeypatch.setattr(
        command, "worker_command_line", lambda: [sys.executable, "-I", "-S", str(STAND_IN), str(made.log)]
    )
    monkeypatch.setattr(worker_pool, "SHORTEST_BACKOFF_S", 0.001)
    return made


def test_every_take_is_converted_once_and_workers_are_kept(
    studio: Studio, capsys: pytest.CaptureFixture[str]
) -> None:
    names = [f"day{day}/take{take}" for day in (1, 2) for take in range(4)]
    studio.takes(*names)
    assert studio.batch() == 0
    said = capsys.readouterr()
    assert sorted(job["take"] for job in studio.received_jobs) == names
    assert len({job["process"] for job in studio.received_jobs}) <= 2
    assert said.err == "" and "8 takes: 8 converted." in said.out
    assert [line.split("]")[0] for line in said.out.splitlines()[:8]] == [f"[{n}/8" for n in range(1, 9)]
    assert {row["status"] for row in studio.summary.values()} == {"converted"}


def test_failures_stop_nothing_and_are_said_kept_and_forgotten(
    studio: Studio, capsys: pytest.CaptureFixture[str]
) -> None:
    studio.takes("a", "wrong", "z")
    assert studio.batch() == 1
    said = capsys.readouterr()
    sentence = f"{studio.shoot / 'wrong'}: the camera is upside down"
    assert said.out.count(sentence) == 2 and "3 takes: 2 converted, 1 failed." in said.out
    (line,) = said.err.splitlines()
    assert "1 of 3 takes failed: wrong" in line
    assert studio.summary["wrong"] | {"status": "failed", "error": sentence} == studio.summary["wrong"]
    failure = read_failure(studio.out, "wrong")
    assert failure is not None and (failure.error, failure.kind) == (sentence, "input")
    assert read_failure(studio.out, "a") is None
    assert studio.batch("--take", "a", "--json") == 0
    assert json.loads(capsys.readouterr().out)["counts"] == {
        "converted": 1,
        "unchanged": 0,
        "failed": 0,
        "waiting": 0,
    }
    assert studio.summary["wrong"]["status"] == "failed"


def test_a_lost_worker_costs_its_take_one_retry(studio: Studio, capsys: pytest.CaptureFixture[str]) -> None:
    studio.takes("a", "crash", "stumble", "z", *(["killed"] if os.name == "posix" else []))
    assert studio.batch() == 1
    said = capsys.readouterr().out
    tries = Counter(job["take"] for job in studio.received_jobs)
    assert tries["a"] == tries["z"] == 1 and tries["crash"] == tries["stumble"] == 2
    assert "stumble  converted" in said and "the process that converted it ended with exit status 9" in said
    failure = read_failure(studio.out, "crash")
    assert failure is not None and failure.kind == "crash"
    if os.name == "posix":
        assert tries["killed"] == 2 and "was killed by SIGKILL" in said
    by_take = {}
    for job in studio.received_jobs:
        by_take.setdefault(job["take"], []).append(job["process"])
    assert len(set(by_take["crash"])) == 2  # another process each time


def test_a_worker_that_says_nothing_is_given_up(
    studio: Studio, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    studio.takes("a", "hang")
    monkeypatch.setattr(command, "HEARTBEAT_TIMEOUT_S", 0.3)
    assert studio.batch(jobs=1) == 1
    assert "hang: the process that converted it told of no progress for" in capsys.readouterr().out
    assert [job["take"] for job in studio.received_jobs] == ["a", "hang", "hang"]


def test_a_worker_that_has_grown_is_replaced(studio: Studio) -> None:
    studio.takes("grown-1", "grown-2", "z")
    assert studio.batch(jobs=1) == 0
    first, second, last = [job["process"] for job in studio.received_jobs]
    assert first != second != last


def test_a_busy_take_comes_last_and_is_taken_as_it_is(
    studio: Studio, capsys: pytest.CaptureFixture[str]
) -> None:
    studio.takes("busy", "m", "z")
    assert studio.batch("--again", jobs=1) == 0
    assert [job["take"] for job in studio.received_jobs] == ["busy", "m", "z", "busy", "busy"]
    assert [job["again"] for job in studio.received_jobs] == [True, True, True, False, False]
    assert "3 takes: 2 converted, 1 unchanged." in capsys.readouterr().out


def test_no_worker_no_batch(
    studio: Studio, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    studio.takes("a", "b")
    broken = [sys.executable, "-I", "-S", str(STAND_IN), str(studio.log.with_name("broken.log"))]
    monkeypatch.setattr(command, "worker_command_line", lambda: broken)
    assert studio.batch() == 1
    assert "no worker process starts: the module cv9 is missing" in capsys.readouterr().err
    assert studio.summary["a"]["status"] == "waiting" and read_failure(studio.out, "a") is None
    monkeypatch.setattr(command, "worker_command_line", lambda: [str(studio.shoot / "no_such_program")])
    assert studio.batch() == 1
    assert "no_such_program: cannot be run" in capsys.readouterr().err


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no signal to one process")
def test_an_interruption_ends_the_workers_and_says_how_far_it_has_come(
    studio: Studio, capsys: pytest.CaptureFixture[str]
) -> None:
    studio.takes("a", "interrupt", "z")
    assert studio.batch(jobs=1) == 130
    said = capsys.readouterr()
    assert (
        said.err == f"{program_name()}: interrupted; 1 of 3 takes are converted; the same command goes on\n"
    )
    statuses = {name: row["status"] for name, row in studio.summary.items()}
    assert statuses == {"a": "converted", "interrupt": "waiting", "z": "waiting"}
    for job in studio.received_jobs:
        with pytest.raises(ProcessLookupError):
            os.kill(job["process"], 0)


def test_an_interruption_of_the_end_does_not_say_that_nothing_was_written(
    studio: Studio, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(self: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(command.BatchOutcomes, "finish", interrupted)
    studio.takes("a", "b")
    assert studio.batch() == 130
    assert "2 of 2 takes are converted" in capsys.readouterr().err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no disk that is always full")
def test_a_log_that_cannot_grow_stops_nothing(
    studio: Studio, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    studio.takes("a", "b")
    for more, status in (((), 0), (("--again", "--json"), 1)):
        with monkeypatch.context() as patched, open("/dev/full", "w", encoding="utf-8") as full:
            patched.setattr(sys, "stdout", full)
            assert studio.batch(*more) == status
    assert "standard output cannot be written" in capsys.readouterr().err
    assert [row["status"] for row in studio.summary.values()] == ["converted", "converted"]


def test_parts_share_the_takes(studio: Studio) -> None:
    names = [f"take{number}" for number in range(5)]
    studio.takes(*names)
    for part in (1, 2, 3):
        assert studio.batch("--part", f"{part}/3") == 0
    assert sorted(job["take"] for job in studio.received_jobs) == names
    assert list(studio.summary) == names


def test_a_list_says_which_takes_and_how(studio: Studio) -> None:
    studio.takes("a", "b", "c")
    listed = studio.shoot / "night.jsonl"
    listed.write_text('{"take": "c"}\n\n{"take": "a", "method": "ekf", "// why": "try"}\n', encoding="utf-8")
    assert main(["batch", str(listed), "--output", str(studio.out), "--jobs", "1"]) == 0
    assert [job["take"] for job in studio.received_jobs] == ["a", "c"]
    assert studio.received_jobs[0]["nearest"]["method"] == "ekf"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--jobs", "0"], "--jobs is 0"),
        (["--part", "3/2"], "--part is 3/2"),
        (["--part", "two"], "--part is two"),
        (["--take", "tak1"], "--take is tak1 (is take1 meant?)"),
        (["--library", "no_such_library"], "no_such_library"),
        (["--keyframes", "posed.json"], "--keyframes: invalid choice: 'posed.json'"),
        (["--keyframes", "auto", "--library", "walking"], "--library walking with one; give one of them"),
        (["--floor", "nan"], "--floor is nan"),
        (["--method", "magic"], "magic"),
    ],
)
def test_an_unusable_command_line_writes_nothing(
    words: list[str], sentence: str, studio: Studio, capsys: pytest.CaptureFixture[str]
) -> None:
    studio.takes("take1")
    assert main(["batch", str(studio.shoot), "--output", str(studio.out), *words]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert sentence in line and not studio.out.exists() and studio.received_jobs == []


def test_an_unusable_shoot_writes_nothing(studio: Studio, capsys: pytest.CaptureFixture[str]) -> None:
    assert studio.batch() == 2
    assert f"{studio.shoot}: no such folder" in capsys.readouterr().err
    studio.shoot.mkdir()
    assert studio.batch() == 2
    assert "holds no take" in capsys.readouterr().err
    studio.takes("a")
    assert main(["batch", str(studio.shoot), "--output", str(studio.shoot)]) == 2
    assert "is the shoot's own folder" in capsys.readouterr().err
    assert not studio.out.exists() and studio.received_jobs == []


@pytest.mark.parametrize(
    ("done", "frames", "share"),
    [
        ([0.0, 0.0, 0.0], [300, None, 100], 0.0),
        ([1.0, 0.5, 0.0], [300, None, 100], (300 + 100) / 600),
        ([1.0, 1.0, 0.0], [300, 50, 100], 350 / 450),
        ([0.5, 0.0], [None, None], 0.25),
        ([], [], 1.0),
    ],
)
def test_the_share_of_all_work_counts_frames_where_they_are_known(
    done: list[float], frames: list[int | None], share: float
) -> None:
    assert share_done(done, frames) == pytest.approx(share)
