"""Takes of a shoot and results below a folder: what is found, and what is none."""

import json
import os
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from _command_line import RECORD
from keymark.core.errors import InputError
from keymark.core.shoot import discovery, outcomes
from keymark.core.shoot.discovery import check_output, find_takes, open_shoot
from keymark.core.shoot.outcomes import find_results
from keymark.core.take.conversion_record import write_record


def make(folder: Path, *paths: str) -> Path:
    """Make files, empty but for JSON; a path that ends with a slash is a folder."""
    for way in paths:
        path = folder / way
        if way.endswith("/"):
            path.mkdir(parents=True)
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("{}" if path.suffix == ".json" else "", encoding="utf-8")
    return folder


def names(folder: Path, without: Path | None = None) -> list[str]:
    return [take.name for take in find_takes(folder, without).takes]


@pytest.mark.parametrize(
    ("paths", "found"),
    [
        (["b/take.json", "b/deeper/take.json", "a/take.json"], ["a", "b"]),
        (["take.json", "clip.mp4"], ["."]),
        (["shoot.json", "x.mp4", "day/y.MOV", "day/._y.mov", ".trash/z.mp4", "notes.txt"], ["day/y", "x"]),
        (["x.mp4", "day/shoot.json", "day/y.mp4"], ["day/y"]),
        (["shoot.json", "x/1.png", "x/2.png", "y/one.jpg"], ["x", "y"]),
        (["shoot.json", "x/1.png", "x/2.png", "x/masks/1.png"], ["x"]),
        (["shoot.json", "poster.jpg", "day/x.mp4", "day/still.jpg"], ["day/x"]),
        (["shoot.json", "x.mp4", "old/x/conversion.json", "old/x/report/1.png", "old/x/report/2.png"], ["x"]),
        (["shoot.json", "1.png", "2.png"], ["."]),
    ],
    ids=[
        "folders",
        "itself",
        "clips",
        "described below",
        "images",
        "masks",
        "stills",
        "results",
        "images itself",
    ],
)
def test_takes_are_found(paths: list[str], found: list[str], tmp_path: Path) -> None:
    assert names(make(tmp_path / "shoot", *paths)) == found


def test_the_results_are_left_out(tmp_path: Path) -> None:
    shoot = make(tmp_path / "shoot", "shoot.json", "x.mp4", "out/y.mp4", "out/z/take.json")
    assert names(shoot, shoot / "day" / ".." / "out") == ["x"]


def test_links_to_folders_are_not_followed(tmp_path: Path) -> None:
    shoot = make(tmp_path / "shoot", "a/take.json", "b/")
    (shoot / "b" / "circle").symlink_to(shoot, target_is_directory=True)
    assert names(shoot) == ["a"]


@pytest.mark.parametrize(
    ("paths", "sentence"),
    [
        (["shoot.json", "x.mp4", "x.mov"], "have one name, 'x'"),
        (["shoot.json", "x.mp4", "x/1.png", "x/2.png"], "have one name, 'x'"),
        (["shoot.json", "Ärm.mp4", "ärm.mov"], "have one name, 'ärm'"),
        (["shoot.json", "Cafe\u0301.mp4", "caf\u00e9.mov"], "have one name"),
        (["shoot.json", "day.mp4", "day/x.mp4"], "would lie among those of"),
        (["shoot.json", "summary.html.mp4"], "where a batch keeps its own summary.html"),
        (["x.mp4", "notes.txt"], "holds no take"),
    ],
    ids=["endings", "folder", "case", "accents", "below", "summary", "none"],
)
def test_takes_that_cannot_be_told_apart_are_refused(paths: list[str], sentence: str, tmp_path: Path) -> None:
    if len({path.casefold() for path in paths}) < len(paths):
        pytest.skip("this file system cannot hold both")
    with pytest.raises(InputError, match=sentence):
        find_takes(make(tmp_path / "shoot", *paths))


def test_an_error_of_reading_names_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shoot = make(tmp_path / "shoot", "a/take.json", "closed/take.json")
    listing = Path.iterdir

    def fail(self: Path) -> object:
        if self.name == closed:
            raise PermissionError(13, "Permission denied")
        return listing(self)

    monkeypatch.setattr(Path, "iterdir", fail)
    closed = "closed"
    assert names(shoot) == ["a", "closed"]
    closed = "shoot"
    with pytest.raises(InputError, match="shoot: cannot be read"):
        find_takes(shoot)


def test_depth_and_number_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shoot = make(tmp_path / "shoot", "/".join(["d"] * 6) + "/take.json", "a/take.json", "b/take.json")
    monkeypatch.setattr(discovery, "DEEPEST", 4)
    with pytest.raises(InputError, match="more than 4 folders deep"):
        find_takes(shoot)
    monkeypatch.undo()
    monkeypatch.setattr(discovery, "MOST_TAKES", 2)
    with pytest.raises(InputError, match="more than 2 takes"):
        find_takes(shoot)


def test_one_clip_is_a_shoot_of_one(tmp_path: Path) -> None:
    shoot = make(tmp_path / "shoot", "shoot.json", "day/x.mp4", "day/y.mp4")
    (take,) = open_shoot(shoot / "day" / "x.mp4").takes
    assert (take.name, take.path) == ("x", shoot / "day" / "x.mp4")


@pytest.mark.parametrize(
    ("output", "sentence"),
    [
        ("shoot", "is the shoot's own folder"),
        ("shoot/day/x/..", "would lie in"),
        (".", None),
        ("shoot/out", None),
        ("shoot/day/x/out", None),
        ("file", "is a file"),
    ],
)
def test_results_may_not_lie_over_takes(output: str, sentence: str | None, tmp_path: Path) -> None:
    folder = make(tmp_path / "shoot", "day/x/take.json", "x/take.json")
    make(tmp_path, "file")
    shoot = find_takes(folder)
    if sentence is None:
        check_output(shoot, tmp_path / output)
        return
    with pytest.raises(InputError, match=sentence):
        check_output(shoot, tmp_path / output)


def write_list(path: Path, *lines: object) -> Path:
    text = "\n".join(line if isinstance(line, str) else json.dumps(line) for line in lines)
    path.write_text(text, encoding="utf-8")
    return path


def test_a_list_names_takes_and_overrides_their_fields(tmp_path: Path) -> None:
    make(tmp_path, "shoot.json", "day/x.mp4", "a/take.json")
    listed = write_list(
        tmp_path / "night.jsonl", {"take": "day/x.mp4", "method": "ekf", "//": "\u2028"}, "", {"take": "a"}
    )
    shoot = open_shoot(listed)
    assert [take.name for take in shoot.takes] == ["a", "day/x"] and shoot.folder == tmp_path
    x = shoot.takes[1]
    assert (x.path, x.overrides_location) == (tmp_path / "day" / "x.mp4", f"{listed}, line 1")
    assert x.describe().settings.method == "ekf"


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        ([], "lists no take"),
        (['{"take": "a"'], "line 1.*no valid JSON"),
        (['{"take": "a"}', "[1]"], "line 2: holds \\[1\\]"),
        ([{"take": "a"}, {"tak": "b"}], "line 2 has the unknown field 'tak'.*'take'"),
        ([{"method": "ekf"}], "line 1: take is missing"),
        ([{"take": "../a"}], r"line 1: take is '\.\./a'"),
        ([{"take": "/a"}], "line 1: take is '/a'"),
        ([{"take": 3}], "line 1: take is 3"),
        ([{"take": "."}], r"line 1: take is '\.'"),
        ([{"take": "a"}, {"take": "A"}], "have one name"),
        ([{"take": "day /a."}, {"take": "day/a"}], "have one name"),
        ([{"take": ".keymark/a"}], ".*where a batch keeps its own .keymark"),
        (['{"take": "\\udcff"}'], "line 1: .*half of a character"),
    ],
)
def test_a_damaged_list_is_one_sentence(lines: list[object], sentence: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"night.jsonl.*{sentence}|^{sentence}"):
        open_shoot(write_list(tmp_path / "night.jsonl", *lines))


def test_a_list_is_bounded_and_must_be_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    listed = write_list(tmp_path / "night.jsonl", {"take": "a"}, {"take": "b"})
    for name, value, sentence in (
        ("LARGEST_BYTES", 20, "is longer than"),
        ("LONGEST_LINE_BYTES", 10, "line 1: has 13 characters"),
        ("MOST_TAKES", 1, "more than 1 takes"),
    ):
        with monkeypatch.context() as bounded, pytest.raises(InputError, match=sentence):
            bounded.setattr(discovery, name, value)
            open_shoot(listed)
    listed.write_bytes(b"\xff\xfe{}")
    with pytest.raises(InputError, match="in UTF-8"):
        open_shoot(listed)
    with pytest.raises(InputError, match="nowhere.jsonl: no such file"):
        open_shoot(tmp_path / "nowhere.jsonl")


def add(folder: Path) -> Path:
    folder.mkdir(parents=True)
    write_record(folder, replace(RECORD, take=folder.name.encode(errors="replace").decode()))
    return folder


def test_results_are_named_by_their_path_and_other_folders_skipped(tmp_path: Path) -> None:
    for name in ("b", "a/two", "a/one", ".keymark/x", "a/one/inner", "a/.one-1f"):
        add(tmp_path / name)
    (tmp_path / "half").mkdir()
    (tmp_path / "half" / "motion.json").write_text("{}", encoding="utf-8")
    (tmp_path / "again").symlink_to(tmp_path, target_is_directory=True)
    sound, damaged = find_results(tmp_path)
    assert [result.name for result in sound] == ["a/one", "a/two", "b"]
    assert sound[0].record.take == "one" and damaged == {}
    assert [result.name for result in find_results(tmp_path / "b")[0]] == ["b"]


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are valid text")
def test_names_that_are_no_text_are_escaped(tmp_path: Path) -> None:
    add(Path(os.fsdecode(os.fsencode(tmp_path) + b"/na\xefve")))
    assert [result.name for result in find_results(tmp_path)[0]] == ["na\\udcefve"]


def test_folders_that_cannot_be_read_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    add(tmp_path / "a")
    (tmp_path / "shut").mkdir()
    through = Path.iterdir

    def iterdir(folder: Path) -> object:
        if folder.name == shut:
            raise PermissionError(13, "Permission denied")
        return through(folder)

    monkeypatch.setattr(outcomes.Path, "iterdir", iterdir)
    shut = "shut"
    sound, damaged = find_results(tmp_path)
    assert [result.name for result in sound] == ["a"]
    assert "Permission denied" in damaged["shut"]
    shut = tmp_path.name
    with pytest.raises(InputError, match=r"cannot be read \(Permission denied\)"):
        find_results(tmp_path)
