"""The library registry."""

from dataclasses import replace
from pathlib import Path

import pytest
from _libraries import small_library
from keymark.core.errors import InputError
from keymark.core.prior.library import write_library
from keymark.core.prior.registry import find_library, library_path, registered_libraries

LIBRARY = small_library()


@pytest.fixture
def folders(tmp_path: Path) -> list[Path]:
    """Own libraries before shipped ones: `small_steps` in both, `walk` in the second; one is not there."""
    own, shipped = tmp_path / "own", tmp_path / "shipped"
    write_library(own / "small_steps.json", replace(LIBRARY, version=1, title="Mine"))
    write_library(shipped / "small_steps.json", LIBRARY)
    write_library(shipped / "walk.json", replace(LIBRARY, identifier="walk", title="A walk"))
    return [own, tmp_path / "nowhere", shipped]


def test_the_earliest_folder_counts(folders: list[Path]) -> None:
    registered = registered_libraries(folders)
    assert [(entry.identifier, entry.title, entry.version) for entry in registered] == [
        ("walk", "A walk", 3),
        ("small_steps", "Mine", 1),
    ]
    assert registered[1].path.parent == folders[0]


def test_within_a_folder_the_newest_counts(folders: list[Path]) -> None:
    write_library(folders[0] / "a copy.json", replace(LIBRARY, version=2, title="Newer"))
    assert find_library("small_steps", folders).title == "Newer"


def test_a_broken_file_says_what_is_wrong_and_hides_nothing(folders: list[Path]) -> None:
    (folders[0] / "broken.json").write_text('{"schema": "keymark-library", ')
    (folders[0] / "notes.txt").write_text("no library")
    (folders[0] / "folder.json").mkdir()
    broken = next(entry for entry in registered_libraries(folders) if entry.library is None)
    assert broken.identifier == "broken" and "no valid JSON" in broken.problem and "\n" not in broken.problem
    assert len(registered_libraries(folders)) == 3
    with pytest.raises(InputError, match="no valid JSON"):
        find_library("broken", folders)


def test_libraries_are_found_by_name_and_by_file(folders: list[Path]) -> None:
    assert find_library("WALK", folders).identifier == "walk"
    assert find_library("a walk", folders).identifier == "walk"
    assert find_library(folders[2] / "small_steps.json", folders).title == LIBRARY.title
    assert find_library(str(folders[2] / "small_steps.json"), []).title == LIBRARY.title


@pytest.mark.parametrize("name", ["walking", "../walk", "", "walk/../../secret", "x" * 10**5, "no\nsuch"])
def test_an_unknown_name_is_one_sentence(folders: list[Path], name: str) -> None:
    with pytest.raises(InputError) as caught:
        find_library(name, folders)
    assert len(str(caught.value).splitlines()) == 1
    if name == "walking":
        assert "'walk' meant" in str(caught.value) and "small_steps" in str(caught.value)


@pytest.mark.parametrize(
    "identifier", ["../x", "a/b", "C:x", "con", "nul.x", "Walk", ".walk", "walk.", "", "a b", "auto"]
)
def test_a_librarys_file_stays_in_its_folder(tmp_path: Path, identifier: str) -> None:
    assert library_path(tmp_path, "walk.2_b-c") == tmp_path / "walk.2_b-c.json"
    with pytest.raises(InputError, match="identifier"):
        library_path(tmp_path, identifier)


def test_a_name_counts_before_a_title(folders: list[Path]) -> None:
    write_library(folders[0] / "a.json", replace(LIBRARY, identifier="zebra", title="walk"))
    (folders[0] / "walk.json").write_text("{")
    assert find_library("walk", folders).identifier == "walk"
    assert find_library("A walk", folders).identifier == "walk"
