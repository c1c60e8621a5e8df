"""Disks that fill up, are read-only or mounted at the output: real file systems, in memory."""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy
import pytest
from _faults import tree
from _results import blend_is_of, hidden_files, is_whole, same_in_every_run
from _synthetic_take import write_synthetic_take
from keymark.core.files.paths import real_path
from keymark.operators.cli.main import main

pytestmark = pytest.mark.faults
OLDER = ("--method", "interpolation", "--no-report", "--quiet")
NEWER = ("--method", "interpolation", "--quiet")


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_synthetic_take(tmp_path_factory.mktemp("takes") / "tiny", 8, 4)


def convert(take: Path, out: Path, words: tuple[str, ...]) -> int:
    return main(["convert", str(take), "--output", str(out), *words])


@contextmanager
def mounted(folder: Path, *words: str) -> Iterator[None]:
    """Mount a file system at a folder, or skip the test where that is not permitted."""
    folder.mkdir(parents=True, exist_ok=True)
    if sys.platform != "linux" or os.geteuid() != 0 or shutil.which("mount") is None:
        pytest.skip("only root may mount")
    done = subprocess.run(["mount", *words, str(folder)], capture_output=True, text=True)
    if done.returncode != 0:
        pytest.skip(f"this machine mounts nothing: {done.stderr.strip()}")
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)


def remount(folder: Path, options: str) -> None:
    subprocess.run(["mount", "-o", f"remount,{options}", str(folder)], check=True)


@pytest.fixture(scope="module")
def wanted(take: Path) -> dict[str, bytes | None]:
    out = take.parent / "disk" / "results" / "out"
    assert convert(take, out, NEWER) == 0
    results = same_in_every_run(out)
    shutil.rmtree(out.parents[1])
    return results


def test_a_disk_that_fills_up_keeps_the_older_results(
    take: Path, wanted: dict[str, bytes | None], capsys: pytest.CaptureFixture[str]
) -> None:
    disk = take.parent / "disk"
    out = disk / "results" / "out"
    with mounted(disk, "-t", "tmpfs", "-o", "size=16m", "none"):
        assert convert(take, out, OLDER) == 0
        before = tree(disk)
        used = sum(-(-len(held) // 4096) * 4 for held in before.values() if held is not None)
        failed = 0
        for room in (0, 4, 8, 16, 32, 64, 96, 128, 160, 192, 256, 512):
            remount(disk, f"size={used + room}k")
            capsys.readouterr()
            status = convert(take, out, NEWER)
            said = capsys.readouterr().err
            if status == 0:
                assert same_in_every_run(out) == wanted and blend_is_of(out)
                remount(disk, "size=16m")
                assert convert(take, out, OLDER) == 0
                before = tree(disk)
                continue
            failed += 1
            assert status == 1 and len(said.splitlines()) == 1 and "Traceback" not in said
            assert tree(disk) == before, f"{room} KiB of room"
        assert failed >= 6
        remount(disk, "size=16m")
        assert convert(take, out, NEWER) == 0
        assert same_in_every_run(out) == wanted and is_whole(out) and not hidden_files(disk)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such limit")
def test_files_that_may_not_grow_further_are_noticed(
    take: Path, wanted: dict[str, bytes | None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import resource

    out = take.parent / "disk" / "results" / "out"
    assert convert(take, out, OLDER) == 0
    sizes = sorted({len(held) for held in wanted.values() if held})
    sizes = sorted({1, *sizes, (out / "motion.blend").stat().st_size})
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    for size in sizes:
        before = tree(out.parents[1])
        capsys.readouterr()
        resource.setrlimit(resource.RLIMIT_FSIZE, (size - 1, hard))
        try:
            status = convert(take, out, NEWER)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        said = capsys.readouterr().err
        if size == sizes[-1] and status == 0:  # Blender's file is not always of one size
            assert is_whole(out) and blend_is_of(out)
            continue
        assert status == 1 and len(said.splitlines()) == 1, f"files of up to {size - 1} bytes"
        assert tree(out.parents[1]) == before
    shutil.rmtree(out.parents[1])


def test_what_is_read_may_lie_on_a_disk_that_cannot_be_written(
    take: Path, wanted: dict[str, bytes | None], tmp_path: Path
) -> None:
    disk = take.parent / "disk"
    before = tree(take)
    with mounted(take, "--bind", str(take)):
        remount(take, "bind,ro")
        assert convert(take, disk / "results" / "out", NEWER) == 0
        assert same_in_every_run(disk / "results" / "out") == wanted
    assert tree(take) == before
    shutil.rmtree(disk)


def test_results_on_a_disk_that_cannot_be_written_are_refused(
    take: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    disk = tmp_path / "disk"
    with mounted(disk, "-t", "tmpfs", "-o", "size=4m", "none"):
        (disk / "old").mkdir()
        remount(disk, "ro")
        for out in (disk / "old", disk / "new" / "out"):
            assert convert(take, out, NEWER) == 2
            said = capsys.readouterr().err
            assert len(said.splitlines()) == 1 and str(out) in said and "cannot be written" in said


def test_a_folder_that_is_a_disk_of_its_own_is_filled_from_within(take: Path, tmp_path: Path) -> None:
    out = tmp_path / "results" / "out"
    with mounted(out, "-t", "tmpfs", "-o", "size=16m", "none"):
        assert convert(take, out, OLDER) == 0
        script = Path(__file__).resolve().parents[2] / "_dying.py"
        for touch in (30, 60, 90):
            words = [sys.executable, str(script), str(touch), str(out), "convert", str(take)]
            done = subprocess.run([*words, "--output", str(out), *NEWER], capture_output=True, text=True)
            assert done.returncode <= 0, done.stderr
            is_whole(out)
        assert convert(take, out, NEWER) == 0
        assert is_whole(out) and blend_is_of(out) and not hidden_files(out)
        assert not [name for name in os.listdir(out) if name.startswith(".") and name != ".as_made.json"]
    assert os.listdir(out.parent) == ["out"]


def odd_paths(folder: Path) -> dict[str, Path]:
    """Paths that have a meaning to Blender, or are hard on programs."""
    return {
        "hashes, which Blender turns into frame numbers": folder / "####" / "take #1 %04d",
        "two slashes, which Blender takes for the open file's folder": Path("/" + str(folder / "twice")),
        "other letters": folder / "Tänzerin 舞者" / "отснято 🎬",
        "a line's end and a point": folder / "two\nlines" / "out.",
        "as long as a name may be": folder / ("n" * 255),
        "blanks": folder / " two  blanks ",
    }


@pytest.mark.skipif(os.name == "nt", reason="Windows forbids such names")
@pytest.mark.parametrize("what", sorted(odd_paths(Path("/"))))
def test_odd_paths_are_read_and_written(what: str, take: Path, tmp_path: Path) -> None:
    folder = odd_paths(tmp_path)[what]
    own, out = folder / "take", folder / "results"
    if what == "as long as a name may be":
        own, out = folder, tmp_path / ("o" * 255)
    shutil.copytree(take, own)
    assert convert(own, out, NEWER) == 0
    assert is_whole(out) and blend_is_of(out)
    assert convert(own, out, OLDER) == 0
    bpy.ops.wm.open_mainfile(filepath=str(real_path(out / "motion.blend")))
    (clip,) = bpy.data.movieclips
    assert os.path.isfile(os.path.normpath(bpy.path.abspath(clip.filepath))) and clip.frame_duration == 8


@pytest.mark.skipif(os.name == "nt", reason="Windows has other limits")
@pytest.mark.parametrize(
    ("path_below", "sentence"),
    [
        (lambda folder: folder.joinpath(*["n" * 200] * 5), "Blender can work with"),
        (lambda folder: folder.joinpath(*["n" * 200] * 25), "too long|Blender can work with"),
        (lambda folder: folder / os.fsdecode(b"odd-\xff"), "no text in UTF-8"),
    ],
)
@pytest.mark.parametrize("of", ["take", "results"])
def test_paths_that_blender_cannot_reach_are_one_sentence(
    of: str,
    path_below: Callable[[Path], Path],
    sentence: str,
    take: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    far = path_below(tmp_path)
    own, out = (far, tmp_path / "out") if of == "take" else (take, far)
    if of == "take":
        try:
            shutil.copytree(take, own)
        except OSError:
            pytest.skip("such a take cannot be")
    before = os.listdir(tmp_path)
    assert convert(own, out, NEWER) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1 and re.search(sentence, said), said
    assert os.listdir(tmp_path) == before


def test_what_somebody_has_changed_is_kept_beside(take: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert convert(take, out, OLDER) == 0
    (out / "motion.blend").write_bytes(b"worked in")
    (out / "motion.bvh").write_text("changed", encoding="utf-8")
    assert convert(take, out, NEWER) == 0
    assert (out / "motion (changed).blend").read_bytes() == b"worked in"
    assert (out / "motion (changed).bvh").read_text(encoding="utf-8") == "changed"
    notes = json.loads((out / "conversion.json").read_text(encoding="utf-8"))["notes"]
    assert any(
        "motion.blend is not as Keymark had made it" in note and "motion (changed).blend" in note
        for note in notes
    )
    assert is_whole(out) and blend_is_of(out)
    for name in ("conversion.json", ".as_made.json"):
        (out / name).unlink()
    (out / "motion.blend").write_bytes(b"of unknown origin")
    assert convert(take, out, NEWER) == 0
    assert (out / "motion (changed 2).blend").read_bytes() == b"of unknown origin"
    assert convert(take, out, OLDER) == 0
    assert not (out / "motion (changed 3).blend").exists()
