"""Result folders: written completely or not at all."""

import json
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


def made(folder: Path) -> Path:
    folder.mkdir()
    return folder


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


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, GeneratorExit])
def test_a_failing_block_changes_nothing(tmp_path: Path, error: type[BaseException]) -> None:
    for out in (tmp_path / "old", tmp_path / "not" / "there"):
        if out.name == "old":
            out.mkdir()
            (out / "motion.json").write_text("old", encoding="utf-8")
        before = tree(tmp_path)
        with pytest.raises(error), output_folder(out) as staging_folder:
            fill(staging_folder, "new")
            raise error
        assert tree(tmp_path) == before


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


def test_a_run_interrupted_before_an_update_is_recovered(tmp_path: Path) -> None:
    out, stem = tmp_path / "out", tmp_path / ".keymark-762069bc07a6e1b5"
    fill(made(out), "old")
    fill(made(stem.with_name(f"{stem.name}-new")), "new")
    journal = {"target": "out", "seal": "conversion.json", "made": ["motion.json", "report/speed.png"]}
    journal |= {"gone": ["motion.bvh"], "aside": {"motion.json": "motion (changed).json"}}
    stem.with_name(f"{stem.name}.json").write_text(json.dumps(journal), encoding="utf-8")
    (out / "motion.bvh").write_text("old", encoding="utf-8")
    with output_folder(out):
        pass
    assert tree(tmp_path) == {
        "out": "(folder)",
        "out/motion (changed).json": "old",
        "out/motion.json": "new",
        "out/report": "(folder)",
        "out/report/speed.png": "new",
    }
