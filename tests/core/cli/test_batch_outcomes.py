"""Several machines on one shoot: the last summary has the outcomes of all of them."""

from dataclasses import replace
from pathlib import Path

import pytest
from _outcomes import RECORD
from keymark.core.shoot.discovery import Shoot, ShootTake
from keymark.core.shoot.outcomes import Failure, Outcome, Status, read_failures, write_failure
from keymark.core.take.conversion_record import write_record
from keymark.operators.cli.batch import outcomes as batch_outcomes
from keymark.operators.cli.batch.outcomes import BatchOutcomes
from keymark.operators.cli.console import Console


@pytest.fixture
def shoot(tmp_path: Path) -> Shoot:
    return Shoot(tmp_path, tuple(ShootTake(name, tmp_path / name) for name in ("a", "b")))


def test_a_take_that_is_done_elsewhere_meanwhile_is_in_the_summary(
    shoot: Shoot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    output = tmp_path / "out"
    written: list[dict[str, Status]] = []

    def write(_output: Path, _shoot: Shoot, outcomes: list[Outcome]) -> tuple[Path, ...]:
        written.append({outcome.take: outcome.status for outcome in outcomes})
        if len(written) == 1:
            (output / "b").mkdir(parents=True)
            write_record(output / "b", replace(RECORD, files={}))
        return ()

    monkeypatch.setattr(batch_outcomes, "write_summary", write)
    BatchOutcomes(shoot, output, [], Console(quiet=True, as_json=False)).finish()
    assert [summary["b"] for summary in written] == [Status.WAITING, Status.CONVERTED]


def test_failures_of_takes_that_are_deleted_are_forgotten(shoot: Shoot, tmp_path: Path) -> None:
    output = tmp_path / "out"
    (tmp_path / "day1").mkdir()
    (tmp_path / "day1" / "clip.mp4").touch()
    (tmp_path / "folder").mkdir()
    for name in ("a", "gone", "day1/clip", "day1/gone", "day2/gone", "folder"):
        write_failure(output, Failure(name, "it is cut off", "input"))
    BatchOutcomes(shoot, output, [], Console(quiet=True, as_json=False))
    assert [failure.take for failure in read_failures(output)] == ["a", "day1/clip", "folder"]


def test_a_list_makes_nobody_forget_the_takes_it_lacks(shoot: Shoot, tmp_path: Path) -> None:
    output = tmp_path / "out"
    for name in ("a", "of the larger shoot"):
        write_failure(output, Failure(name, "it is cut off", "input"))
    part = replace(shoot, path=tmp_path / "part.jsonl")
    part.path.touch()
    BatchOutcomes(part, output, [], Console(quiet=True, as_json=False))
    assert [failure.take for failure in read_failures(output)] == ["a", "of the larger shoot"]
