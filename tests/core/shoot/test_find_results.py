"""Discovery of conversion results below a folder, as for `merge`."""

import os
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from _outcomes import RECORD
from keymark.core.errors import InputError
from keymark.core.shoot import outcomes
from keymark.core.shoot.outcomes import find_results
from keymark.core.take.conversion_record import write_record


def add(folder: Path) -> Path:
    folder.mkdir(parents=True)
    write_record(folder, replace(RECORD, take=folder.name.encode(errors="replace").decode()))
    return folder


def test_results_are_named_by_their_path_and_other_folders_skipped(tmp_path: Path) -> None:
    for name in ("b", "a/two", "a/one", ".keymark/x", "a/one/inner", "a/.one-1f"):
        add(tmp_path / name)
    (tmp_path / "half").mkdir()
    (tmp_path / "half" / "motion.json").write_text("{}", encoding="utf-8")
    found = find_results(tmp_path)
    assert [result.name for result in found.sound] == ["a/one", "a/two", "b"]
    assert found.sound[0].record.take == "one" and found.damaged == {}


def test_a_single_result_is_named_after_its_folder(tmp_path: Path) -> None:
    assert [result.name for result in find_results(add(tmp_path / "walk")).sound] == ["walk"]


def test_links_to_folders_are_not_followed(tmp_path: Path) -> None:
    add(tmp_path / "a")
    (tmp_path / "again").symlink_to(tmp_path, target_is_directory=True)
    assert [result.name for result in find_results(tmp_path).sound] == ["a"]


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are valid text")
def test_names_that_are_no_text_are_escaped(tmp_path: Path) -> None:
    add(Path(os.fsdecode(os.fsencode(tmp_path) + b"/na\xefve")))
    assert [result.name for result in find_results(tmp_path).sound] == ["na\\udcefve"]


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
    found = find_results(tmp_path)
    assert [result.name for result in found.sound] == ["a"]
    assert "Permission denied" in found.damaged["shut"]
    shut = tmp_path.name
    with pytest.raises(InputError, match=r"cannot be read \(Permission denied\)"):
        find_results(tmp_path)
