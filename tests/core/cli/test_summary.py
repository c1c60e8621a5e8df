"""Outcomes of a batch and its summary: a line a take and a page, each written atomically."""

import json
import threading
from dataclasses import replace
from pathlib import Path

import pytest
from _command_line import FILES, RECORD, converted, failed, waiting
from keymark.core.errors import ConversionError
from keymark.core.shoot.discovery import Shoot, ShootTake
from keymark.core.shoot.outcomes import Failure, Outcome, Status, read_failures, write_failure
from keymark.core.take.conversion_record import write_record
from keymark.operators.cli.batch import outcomes as batch_outcomes
from keymark.operators.cli.batch.outcomes import LINES, PAGE, BatchOutcomes, write_summary
from keymark.operators.cli.console import Console


def outcomes(output: Path) -> list[Outcome]:
    return [
        waiting(output, "day2/jump"),
        converted(output, "day1/walk", library="walking", matched=(60,), doubtful=(60,)),
        failed(output, "day1/fall", "day1/fall/clip.mp4: no such file", RECORD),
        Outcome("day1/rún\u2028", output / "day1/rún\u2028", Status.UNCHANGED, RECORD),
    ]


def test_a_line_says_of_each_take_what_programs_want(tmp_path: Path) -> None:
    output = tmp_path / "out"
    files = write_summary(output, Shoot(tmp_path / "autumn", ()), outcomes(output))
    assert files == (output / LINES, output / PAGE)
    text = (output / LINES).read_bytes().decode("ascii")
    rows = [json.loads(line) for line in text.splitlines()]
    assert [row["take"] for row in rows] == ["day1/fall", "day1/rún\u2028", "day1/walk", "day2/jump"]
    assert {tuple(row) for row in rows} == {tuple(rows[0])}
    assert [row["status"] for row in rows] == ["failed", "unchanged", "converted", "waiting"]
    fall, run, walk, jump = rows
    assert fall["error"].endswith("no such file") and fall["confidence"] is None and fall["files"] == []
    assert walk["files"] == [f"day1/walk/{name}" for name in (*FILES, "conversion.json")]
    assert (walk["library"], walk["matched"], walk["weak_frames"]) == ("walking", [60], [87, 31])
    assert (walk["doubtful"], run["doubtful"], jump["doubtful"]) == ([60], [], None)
    assert walk["evidence"]["markers"] == ["trunk", "shin.L"] and not walk["evidence"]["contours"]
    assert (walk["seconds"], run["seconds"], run["frames"], jump["error"]) == (12.0, None, 120, None)
    assert ">autumn</bdi></h1>" in (output / PAGE).read_text(encoding="utf-8")


def test_the_same_outcomes_give_the_same_bytes(tmp_path: Path) -> None:
    shoot = Shoot(tmp_path, ())
    first = [file.read_bytes() for file in write_summary(tmp_path, shoot, outcomes(tmp_path))]
    again = [file.read_bytes() for file in write_summary(tmp_path, shoot, outcomes(tmp_path)[::-1])]
    assert first == again
    assert sorted(file.name for file in tmp_path.iterdir()) == [PAGE, LINES]


def test_a_take_that_is_the_shoot_itself(tmp_path: Path) -> None:
    outcome = Outcome(".", tmp_path, Status.CONVERTED, RECORD)
    lines, page = write_summary(tmp_path, Shoot(tmp_path / "walk", ()), [outcome])
    assert json.loads(lines.read_text(encoding="ascii"))["files"] == [*FILES, "conversion.json"]
    assert 'href="./motion.blend"' in page.read_text(encoding="utf-8")


def test_several_machines_write_at_once_and_readers_see_whole_files(tmp_path: Path) -> None:
    shoot, over = Shoot(tmp_path, ()), threading.Event()
    seen: set[int] = set()
    wrong: list[BaseException] = []

    def write(takes: int) -> None:
        try:
            for _ in range(6):
                write_summary(tmp_path, shoot, [waiting(tmp_path, f"take{n}") for n in range(takes)])
        except BaseException as error:
            wrong.append(error)

    def read() -> None:
        try:
            while not over.is_set():
                rows = (tmp_path / LINES).read_text(encoding="ascii").splitlines(keepends=True)
                assert all(json.loads(row) and row.endswith("\n") for row in rows)
                assert (tmp_path / PAGE).read_text(encoding="utf-8").endswith("</html>\n")
                seen.add(len(rows))
        except BaseException as error:
            wrong.append(error)

    write_summary(tmp_path, shoot, [waiting(tmp_path, "take0")])
    reader = threading.Thread(target=read)
    writers = [threading.Thread(target=write, args=(takes,)) for takes in (2, 30, 300)]
    for thread in (reader, *writers):
        thread.start()
    for thread in writers:
        thread.join()
    over.set()
    reader.join()
    assert wrong == [] and seen <= {1, 2, 30, 300}
    assert len((tmp_path / LINES).read_text(encoding="ascii").splitlines()) in (2, 30, 300)


def test_a_folder_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    (tmp_path / "out").touch()
    with pytest.raises(ConversionError, match="out"):
        write_summary(tmp_path / "out", Shoot(tmp_path, ()), [])


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
