"""`keymark library`: its output and files; mistakes are one line with status 2."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _libraries import small_library
from _synthetic_take import BODY, true_postures
from keymark.core.prior.library import read_library, write_library
from keymark.core.take.motion import Motion, write_motion
from keymark.operators.cli.conversion import blender_files
from keymark.operators.cli.main import main

FRAMES = 40


@pytest.fixture(autouse=True)
def shelf(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A search path of one folder, with a library and a broken file."""
    folder = tmp_path / "shelf"
    folder.mkdir()
    write_library(folder / "any name.json", small_library())
    (folder / "broken.json").write_text("{", encoding="utf-8")
    monkeypatch.setenv(blender_files.VARIABLE, str(folder))
    monkeypatch.setattr(blender_files, "SHIPPED", tmp_path / "nothing")
    return folder


@pytest.fixture
def motion(tmp_path: Path) -> Path:
    posture = true_postures(FRAMES)
    points = BODY.points(BODY.pose(posture))
    unknown = np.full((*points.shape, 3), np.nan)
    made = Motion(BODY, 30.0, 1, np.arange(FRAMES) / 30.0, posture, points, unknown, (0,), "interpolation")
    write_motion(made, tmp_path / "motion.json")
    return tmp_path / "motion.json"


def run(*words: object) -> int:
    return main(["library", *map(str, words)])


def test_the_list_says_what_cannot_be_used(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("list") == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(
        re.match(r"small_steps +Small steps, große Schritte, 3 postures, 2 motions", line) for line in lines
    )
    assert any(line.startswith("broken") and "cannot be used" in line for line in lines)
    assert run("list", "--json") == 0
    rows = {row["identifier"]: row for row in json.loads(capsys.readouterr().out)["libraries"]}
    assert rows["small_steps"]["postures"] == 3 and rows["small_steps"]["problem"] == ""
    assert "line 1" in rows["broken"]["problem"]


def test_a_library_is_shown_by_name_and_by_file(shelf: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = []
    for name in ("small_steps", shelf / "any name.json"):
        assert run("show", name) == 0
        said.append(capsys.readouterr().out)
    assert said[0] == said[1]
    assert "Steps: 3 postures, again and again, 1.00 s" in said[0] and "CC0-1.0" in said[0]
    assert run("show", "small_steps", "--json") == 0
    result = json.loads(capsys.readouterr().out)
    assert [motion["cyclic"] for motion in result["motions"]] == [True, False]


def test_checking_names_every_broken_file(
    shelf: Path, motion: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("check", shelf / "any name.json") == 0
    assert "Small steps" in capsys.readouterr().out
    assert run("check", shelf / "any name.json", shelf / "broken.json", motion) == 2
    said = capsys.readouterr()
    assert len(said.err.splitlines()) == 1 and said.out == ""
    assert "broken.json: line 1" in said.err and "motion.json: schema is None" in said.err


def test_a_motion_is_learned_and_nothing_replaced(
    motion: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "learned.json"
    words: tuple[object, ...] = ("learn", motion, "--title", "Anna Sways", "--output", output)
    assert run(*words, "--count", "12", "--author", "Anna", "--license", "CC0-1.0", "--json") == 0
    said = json.loads(capsys.readouterr().out)
    library = read_library(output)
    assert said["identifier"] == library.identifier == "anna_sways" and said["files"] == [str(output)]
    assert len(library.postures) == 12 and (library.author, library.license) == ("Anna", "CC0-1.0")
    before = output.read_bytes()
    assert run(*words) == 2
    assert "--replace" in capsys.readouterr().err and output.read_bytes() == before
    assert run(*words, "--replace", "--quiet") == 0
    assert read_library(output).author == "Unknown"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "COMMAND"),
        (["bogus"], "bogus"),
        (["show"], "LIBRARY"),
        (["show", "small_step"], "'small_step'.*is 'small_steps' meant"),
        (["show", "../small_steps"], "no such file"),
        (["show", "broken"], "broken.json: line 1"),
        (["learn", "m.json", "--output", "l.json"], "--title"),
        (["learn", "m.json", "--title", "T", "--output", "l.json"], "m.json: no such file"),
        (["learn", "m.json", "--title", "T", "--output", "l.json", "--identifier", "../x"], "--identifier"),
        (["learn", "MOTION", "--title", "T", "--output", "l.json", "--license", "free for all!"], "SPDX"),
        (["learn", "MOTION", "--title", "T", "--output", "l.json", "--count", "400"], "40 frames"),
    ],
)
def test_mistakes_are_one_line(
    words: list[str],
    sentence: str,
    motion: Path,
    shelf: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    monkeypatch.chdir(empty)
    places: dict[str, Any] = {"MOTION": str(motion), "SHELF": str(shelf)}
    filled = [re.sub("MOTION|SHELF", lambda match: places[match[0]], word) for word in words]
    assert run(*filled) == 2
    said = capsys.readouterr()
    assert len(said.err.splitlines()) == 1 and re.search(sentence, said.err), said.err
    assert list(empty.iterdir()) == []
