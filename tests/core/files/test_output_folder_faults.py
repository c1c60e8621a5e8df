"""Result folders, whole or not at all, through kills and full disks at every call of the operating system."""

import json
import os
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from _faults import GROWING, Killed, disk_full, faulty_calls, tree
from keymark.core.errors import BusyError, ConversionError, InputError, KeymarkError
from keymark.core.files import output_folder as module
from keymark.core.files.output_folder import backup_name, output_folder

MANIFEST = "manifest.json"
OWN_FILES = (MANIFEST, "a.bin", "b.bin", "pictures/one.png", "pictures/two.png", "extra/three.png")


@pytest.fixture(autouse=True)
def no_fsync(monkeypatch: pytest.MonkeyPatch) -> None:
    """Unflushed files outlive a killed process all the same; only a loss of power would tell."""
    monkeypatch.setattr(os, "fsync", lambda descriptor: None)


def write_set(folder: Path, text: str, pictures: bool = True) -> None:
    """Write a set of files as a conversion makes it: the manifest lists all others."""
    names = [
        "a.bin",
        "b.bin",
        *(["pictures/one.png", "pictures/two.png"] if pictures else ["extra/three.png"]),
    ]
    for name in names:
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    (folder / MANIFEST).write_text(json.dumps({name: text for name in names}), encoding="utf-8")


def run(out: Path, text: str, pictures: bool = True) -> None:
    with output_folder(out, OWN_FILES, manifest=MANIFEST) as staging_folder:
        write_set(staging_folder, text, pictures)


def is_whole(out: Path) -> bool:
    """Whether a reader would take the folder for finished; then all files of its manifest must be there."""
    if not (out / MANIFEST).exists():
        return False
    for name, text in json.loads((out / MANIFEST).read_text(encoding="utf-8")).items():
        assert (out / name).read_text(encoding="utf-8") == text, "the manifest lists a file that is missing"
    return True


def begin(folder: Path, kind: str) -> Path:
    """An output folder: new, with an older set of other files, or with files of others alone."""
    out = folder / "deep" / "out"
    if kind == "new":
        return out
    out.mkdir(parents=True)
    (out / "mine.txt").write_text("mine", encoding="utf-8")
    if kind == "older":
        run(out, "older", pictures=False)
    return out


KINDS = pytest.mark.parametrize("kind", ["new", "others", "older"])


def expected(folder: Path, kind: str) -> dict[str, bytes | None]:
    run(begin(folder, kind), "newer")
    return tree(folder)


def calls_of(folder: Path, kind: str) -> int:
    out = begin(folder, kind)
    with faulty_calls() as calls:
        run(out, "newer")
    return calls.count


@KINDS
def test_a_run_killed_at_any_call_is_repeated_without_a_trace(kind: str, tmp_path: Path) -> None:
    wanted = expected(tmp_path / "wanted", kind)
    total = calls_of(tmp_path / "counted", kind)
    assert total > 25
    for at in range(1, total + 1):
        folder = tmp_path / str(at)
        out = begin(folder, kind)
        with pytest.raises(Killed), faulty_calls(at):
            run(out, "newer")
        is_whole(out)
        run(out, "newer")
        assert is_whole(out) and tree(folder) == wanted, f"killed at call {at} of {total}"


def test_a_run_that_makes_nothing_recovers_a_killed_one(tmp_path: Path) -> None:
    wanted = expected(tmp_path / "wanted", "older")
    total = calls_of(tmp_path / "counted", "older")
    older = tree(begin(tmp_path / "older", "older").parent)
    found = []
    for at in range(1, total + 1):
        folder = tmp_path / str(at)
        out = begin(folder, "older")
        with pytest.raises(Killed), faulty_calls(at):
            run(out, "newer")
        with output_folder(out, OWN_FILES, manifest=MANIFEST):
            pass
        assert is_whole(out)
        found.append(tree(folder) == wanted)
        assert found[-1] or tree(folder / "deep") == older
    assert found == sorted(found) and 3 < sum(found) < total  # from the journal on


@pytest.mark.faults
def test_the_process_that_recovers_may_be_killed_as_well(tmp_path: Path) -> None:
    wanted = expected(tmp_path / "wanted", "older")
    total = calls_of(tmp_path / "counted", "older")
    for at in range(1, total + 1, 2):
        for again in range(at % 5 + 1, total, 5):
            folder = tmp_path / f"{at}-{again}"
            out = begin(folder, "older")
            with pytest.raises(Killed), faulty_calls(at):
                run(out, "newer")
            with pytest.raises(Killed), faulty_calls(again):
                run(out, "newer")
            is_whole(out)
            run(out, "newer")
            assert is_whole(out) and tree(folder) == wanted, f"killed at calls {at} and {again}"


@KINDS
@pytest.mark.parametrize("lasting", [False, True])
def test_a_disk_that_is_full_at_any_call_changes_nothing(kind: str, lasting: bool, tmp_path: Path) -> None:
    wanted = expected(tmp_path / "wanted", kind)
    out = begin(tmp_path / "counted", kind)
    with faulty_calls(None, disk_full, names=GROWING) as calls:
        run(out, "newer")
    for at in range(1, calls.count + 1):
        folder = tmp_path / f"{at}"
        out = begin(folder, kind)
        before = tree(folder)
        failed = True
        with faulty_calls(at, disk_full, lasting, GROWING) as calls:
            try:
                run(out, "newer")
                failed = False
            except ConversionError as error:
                assert "No space left" in str(error)
        if not failed:
            assert calls.log[at - 1] == "mkdir" and tree(folder) == wanted  # of a folder that was there
            continue
        hidden = [name for name in tree(folder) if ".keymark-" in name]
        assert tree(folder) == before or (lasting and hidden and not (out / MANIFEST).exists())
        run(out, "newer")
        assert tree(folder) == wanted


def test_a_run_interrupted_at_any_call_changes_nothing(tmp_path: Path) -> None:
    out = begin(tmp_path / "counted", "older")
    with faulty_calls(None, disk_full) as calls:
        run(out, "newer")
    for at in range(1, calls.count + 1):
        folder = tmp_path / str(at)
        out = begin(folder, "older")
        before = tree(folder)
        interrupted = False
        with faulty_calls(at, lambda _name: KeyboardInterrupt(), lasting=False):
            try:
                run(out, "newer")
            except KeyboardInterrupt:
                interrupted = True
        assert interrupted
        is_whole(out)
        run(out, "older", pictures=False)
        assert tree(folder) == before


def test_files_that_others_changed_are_backed_up(tmp_path: Path) -> None:
    def again(out: Path) -> None:
        backups: dict[str, str] = {}
        with output_folder(out, OWN_FILES, MANIFEST, backups) as staging_folder:
            write_set(staging_folder, "newer")
            if (out / "a.bin").read_text(encoding="utf-8") == "worked on":
                backups["a.bin"] = "a (changed).bin"

    out = begin(tmp_path / "wanted", "older")
    (out / "a.bin").write_text("worked on", encoding="utf-8")
    with faulty_calls() as calls:
        again(out)
    wanted = tree(tmp_path / "wanted")
    assert wanted["deep/out/a (changed).bin"] == b"worked on" and wanted["deep/out/a.bin"] == b"newer"
    for at in range(1, calls.count + 1):
        folder = tmp_path / str(at)
        out = begin(folder, "older")
        (out / "a.bin").write_text("worked on", encoding="utf-8")
        with pytest.raises(Killed), faulty_calls(at):
            again(out)
        again(out)
        assert tree(folder) == wanted


def test_a_second_backup_gets_a_name_of_its_own(tmp_path: Path) -> None:
    for name in ("motion.blend", "motion (changed).blend"):
        (tmp_path / name).touch()
    assert backup_name(tmp_path / "motion.blend").name == "motion (changed 2).blend"


def test_a_folder_is_one_processs_at_a_time(tmp_path: Path) -> None:
    out = tmp_path / "out"
    said: list[KeymarkError] = []

    def second() -> None:
        try:
            run(out, "second")
        except KeymarkError as error:
            said.append(error)

    with output_folder(out) as staging_folder:
        thread = threading.Thread(target=second)
        thread.start()
        thread.join()
        write_set(staging_folder, "first")
    assert len(said) == 1 and isinstance(said[0], BusyError) and str(out) in str(said[0])
    second()
    assert (out / "a.bin").read_text() == "second" and os.listdir(tmp_path) == ["out"]


def test_threads_that_race_for_a_folder_leave_one_whole_set(tmp_path: Path) -> None:
    out = tmp_path / "above" / "out"
    ended: list[str] = []

    def work(text: str) -> None:
        for _ in range(20):
            try:
                run(out, text, pictures=text == "one")
                ended.append(text)
            except BusyError:
                pass
            with pytest.raises((ZeroDivisionError, BusyError)), output_folder(tmp_path / "above" / text):
                raise ZeroDivisionError

    threads = [threading.Thread(target=work, args=[text]) for text in ("one", "two", "three")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert ended and is_whole(out)
    assert not [name for name in tree(tmp_path) if ".keymark-" in name]


def test_a_journal_that_is_not_to_be_trusted_is_removed(tmp_path: Path) -> None:
    out = begin(tmp_path, "older")
    with faulty_calls() as calls:
        run(out, "newer")
    last = len(calls.log) - calls.log[::-1].index("replace")
    for change in (
        {"made": ["../../elsewhere"]},
        {"gone": ["/etc/passwd"]},
        {"gone": ["..\\..\\elsewhere"]},
        {"aside": {"a.bin": "../a.bin"}},
        {"made": "manifest.json"},
        {"target": "another"},
        {"seal": 5},
        {"made": ["a.bin", "lost.bin"]},
    ):
        with pytest.raises(Killed), faulty_calls(last):
            run(out, "newer")
        (journal,) = out.parent.glob(".keymark-*.json")
        fields = json.loads(journal.read_text(encoding="utf-8"))
        journal.write_text(json.dumps({**fields, **change}), encoding="utf-8")
        before = tree(out)
        with output_folder(out, OWN_FILES, manifest=MANIFEST):
            pass
        assert tree(out) == before and os.listdir(out.parent) == ["out"]
        run(out, "newer")


def names(folder: Path) -> dict[str, Path]:
    return {
        "as long as a name may be": folder / ("n" * 255),
        "in other letters": folder / "Tänzerin 舞者" / "отснято 🎬",
        "like options and patterns": folder / "-o %d #### {x}" / "*?[a].",
        "with a line end": folder / "two\nlines",
        "no text": folder / os.fsdecode(b"odd-\xff"),
    }


@pytest.mark.skipif(os.name == "nt", reason="Windows forbids such names")
@pytest.mark.parametrize("what", sorted(names(Path())))
def test_odd_names_work(what: str, tmp_path: Path) -> None:
    out = names(tmp_path)[what]
    for text in ("older", "newer"):
        run(out, text)
        assert is_whole(out) and os.listdir(out.parent) == [out.name]


def endless(folder: Path) -> Path:
    (folder / "endless").symlink_to(folder / "endless")
    return folder / "endless" / "out"


@pytest.mark.parametrize(
    "path",
    [
        lambda folder: folder / ("n" * 256),
        lambda folder: folder.joinpath(*["n" * 200] * 30),
        lambda folder: folder / "with\0zero",
        endless,
    ],
)
def test_impossible_paths_are_one_sentence(path: Callable[[Path], Path], tmp_path: Path) -> None:
    out = path(tmp_path)
    before = os.listdir(tmp_path)
    with pytest.raises(InputError, match="cannot be written"), output_folder(out):
        pass
    assert os.listdir(tmp_path) == before


def test_a_link_to_nowhere_leads_there(tmp_path: Path) -> None:
    (tmp_path / "out").symlink_to(tmp_path / "disk" / "results")
    run(tmp_path / "out", "newer")
    assert is_whole(tmp_path / "disk" / "results") and (tmp_path / "out").is_symlink()


def texts(folder: Path) -> dict[str, str]:
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
    assert texts(tmp_path / "a" / "b" / "out") == {
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
    assert texts(out) == {"motion.json": "second", "notes.txt": "mine"}


def test_a_path_that_is_no_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="is a file"), output_folder(tmp_path / "file"):
        pass
    with pytest.raises(InputError, match="cannot be written"), output_folder(tmp_path / "file" / "out"):
        pass
    assert texts(tmp_path) == {"file": "mine"}


def test_a_mounted_folder_holds_its_own_staging_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    out.mkdir()
    monkeypatch.setattr(module.os, "access", lambda path, mode: Path(path) == out)
    with output_folder(out) as staging_folder:
        assert staging_folder.parent == out
        fill(staging_folder, "new")
    assert sorted(texts(out)) == ["motion.json", "report", "report/speed.png"]


def test_a_link_to_a_folder_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    (tmp_path / "out").symlink_to(tmp_path / "disk", target_is_directory=True)
    with output_folder(tmp_path / "out") as staging_folder:
        fill(staging_folder, "new")
    assert (tmp_path / "out").is_symlink() and (tmp_path / "disk" / "motion.json").read_text() == "new"
