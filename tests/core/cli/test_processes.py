"""The command line as a process of its own: start, SIGTERM, --help, standard streams and progress."""

import os
import signal
import subprocess
import sys
from io import BytesIO, TextIOWrapper
from pathlib import Path

import pytest
from _command_line import one_line, tree
from _synthetic_take import write_synthetic_take
from keymark.core.progress import Progress
from keymark.operators.cli.blender_silence import blender_silence
from keymark.operators.cli.console import Console
from keymark.operators.cli.main import main

FRAMES = 16


@pytest.fixture
def take(tmp_path: Path) -> Path:
    return write_synthetic_take(tmp_path / "take", FRAMES)


@pytest.fixture
def out(tmp_path: Path) -> Path:
    folder = tmp_path / "results" / "out"
    folder.mkdir(parents=True)
    (folder / "motion.json").write_text("earlier", encoding="utf-8")
    return folder


def module_process(tmp_path: Path, repository: Path, *words: str) -> "subprocess.Popen[str]":
    """`python -m keymark` in a process of its own, whatever the repository's folder is called."""
    links = tmp_path / "links"
    links.mkdir()
    (links / "keymark").symlink_to(repository, target_is_directory=True)
    # Inside a Blender the libraries that its Python lacks lie in a folder of the tests' own.
    places = [str(links), *filter(None, [os.environ.get("KEYMARK_TEST_LIBRARIES")])]
    return subprocess.Popen(
        [sys.executable, "-m", "keymark", *words],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(places)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_it_runs_as_a_module(tmp_path: Path, repository: Path) -> None:
    process = module_process(tmp_path, repository, "convert", "nowhere", "--output", str(tmp_path / "out"))
    said, wrong = process.communicate()
    assert process.returncode == 2 and "nowhere" in one_line(wrong) and "Reading the take" in said


PARTS = {f"scipy.{part}" for part in ("interpolate", "linalg", "ndimage", "optimize", "spatial", "special")}


@pytest.mark.parametrize("words", [("--help",), ("conver",), ("library", "show", "--help")])
def test_help_and_mistakes_wait_for_no_library(
    words: tuple[str, ...], tmp_path: Path, repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPROFILEIMPORTTIME", "1")
    _, told = module_process(tmp_path, repository, *words).communicate()
    loaded = {line.rpartition("|")[2].strip() for line in told.splitlines()}
    assert "keymark.operators.cli.commands" in loaded
    assert not loaded & {"numpy", "scipy", "cv2", "bpy", "tqdm", "asyncio", "keymark.core.files.json_file"}


@pytest.mark.parametrize(
    ("command", "spared"),
    [("batch", {"scipy", "bpy", "keymark.core.estimate.reconstruct"}), ("detect", {*PARTS, "bpy"})],
)
def test_a_command_loads_nothing_that_it_needs_not(command: str, spared: set[str], repository: Path) -> None:
    """A batch leaves estimating to its workers; looking at a clip needs nothing of what solves."""
    words = f"import _boot, sys; _boot.load_package(); import keymark.operators.cli.commands.{command}"
    done = subprocess.run(
        [sys.executable, "-c", f"{words}; print(*sys.modules)"],
        cwd=repository / "tests",
        env={**os.environ, "PYTHONPATH": os.environ.get("KEYMARK_TEST_LIBRARIES", "")},
        capture_output=True,
        text=True,
    )
    loaded = set(done.stdout.split())
    assert f"keymark.operators.cli.commands.{command}" in loaded
    assert not loaded & spared


@pytest.mark.skipif(os.name == "nt", reason="Windows ends processes without asking them")
def test_a_process_that_is_asked_to_end_cleans_up(
    take: Path, out: Path, tmp_path: Path, repository: Path
) -> None:
    before = tree(out.parent)
    # Inside a Blender program this process has bpy, but the Python that it starts has none.
    find = "import importlib.util, sys; sys.exit(importlib.util.find_spec('bpy') is None)"
    has_blender = subprocess.run([sys.executable, "-c", find]).returncode == 0
    words = ("convert", str(take), "--output", str(out)) if has_blender else ("propose", str(take))
    process = module_process(tmp_path, repository, *words)
    assert process.stdout is not None and process.stderr is not None
    for line in process.stdout:
        if line.startswith("Following the markers"):
            process.send_signal(signal.SIGTERM)
            break
    process.stdout.close()
    assert process.wait() == 130
    assert "interrupted" in one_line(process.stderr.read())
    process.stderr.close()
    assert tree(out.parent) == before


def test_a_process_without_standard_streams_does_its_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    take = write_synthetic_take(tmp_path / "take", 8)
    for stream in ("stdin", "stdout", "stderr"):
        monkeypatch.setattr(sys, stream, None)
    assert main(["propose", str(take), "--count", "4"]) == 0
    assert main(["propose", str(take), "--count", "1"]) == 2


def test_blender_may_print_any_path(monkeypatch: pytest.MonkeyPatch) -> None:
    with TextIOWrapper(BytesIO(), encoding="ascii") as stream:
        monkeypatch.setattr(sys, "stdout", stream)
        with blender_silence(debug=False):
            print("舞者")
        with pytest.raises(UnicodeEncodeError):
            print("舞者")


@pytest.mark.parametrize(
    ("quiet", "as_json", "asked", "lines"),
    [
        (False, False, "openjd", ["openjd_status: Solving", "openjd_progress: 45", "openjd_progress: 81"]),
        (True, False, "openjd", []),
        (False, True, "openjd", []),
        (False, False, "", ["Solving ..."]),
    ],
)
def test_a_line_for_each_percent_where_it_is_wanted(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    quiet: bool,
    as_json: bool,
    asked: str,
    lines: list[str],
) -> None:
    monkeypatch.setenv("KEYMARK_PROGRESS", asked)
    with Console(quiet=quiet, as_json=as_json) as console:
        for fraction in (0.5, 0.5001, 0.9, 0.3):
            console.progress(Progress("Solving", fraction))
    assert capsys.readouterr().out.splitlines() == lines
