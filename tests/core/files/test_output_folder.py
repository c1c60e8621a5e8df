"""Result folders: written completely or not at all."""

from pathlib import Path

import pytest
from keymark.core.errors import InputError
from keymark.core.files import output_folder as module
from keymark.core.files.output_folder import output_folder


def tree(folder: Path) -> dict[str, str]:
    """Every file below a folder with its text, and every folder."""
    return {
        str(path.relative_to(folder)): path.read_text(encoding="utf-8") if path.is_file() else "(folder)"
        for path in folder.rglob("*")
    }


def fill(folder: Path, text: str) -> None:
    (folder / "motion.json").write_text(text, encoding="utf-8")
    (folder / "report").mkdir()
    (folder / "report" / "speed.png").write_text(text, encoding="utf-8")


def test_a_new_folder_appears_with_all_files(tmp_path: Path) -> None:
    with output_folder(tmp_path / "a" / "b" / "out") as staging_folder:
        fill(staging_folder, "new")
        assert not (tmp_path / "a" / "b" / "out").exists()
    assert tree(tmp_path / "a" / "b" / "out") == {
        "motion.json": "new",
        "report": "(folder)",
        "report/speed.png": "new",
    }
    assert [path.name for path in (tmp_path / "a" / "b").iterdir()] == ["out"]


def test_files_of_others_stay_and_files_of_earlier_runs_go(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with output_folder(out) as staging_folder:
        fill(staging_folder, "first")
    (out / "notes.txt").write_text("mine", encoding="utf-8")
    with output_folder(out, ["motion.json", "report/speed.png"]) as staging_folder:
        (staging_folder / "motion.json").write_text("second", encoding="utf-8")
    assert tree(out) == {"motion.json": "second", "notes.txt": "mine"}


def test_a_path_that_is_no_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="is a file"), output_folder(tmp_path / "file"):
        pass
    with pytest.raises(InputError, match="cannot be written"), output_folder(tmp_path / "file" / "out"):
        pass
    assert tree(tmp_path) == {"file": "mine"}


def test_a_mounted_folder_holds_its_own_staging_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    out.mkdir()
    monkeypatch.setattr(module.os, "access", lambda path, mode: Path(path) == out)
    with output_folder(out) as staging_folder:
        assert staging_folder.parent == out
        fill(staging_folder, "new")
    assert sorted(tree(out)) == ["motion.json", "report", "report/speed.png"]


def test_a_link_to_a_folder_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    (tmp_path / "out").symlink_to(tmp_path / "disk", target_is_directory=True)
    with output_folder(tmp_path / "out") as staging_folder:
        fill(staging_folder, "new")
    assert (tmp_path / "out").is_symlink() and (tmp_path / "disk" / "motion.json").read_text() == "new"
