"""docs/detectors.md agrees with the code: its commands, placeholders, limits and options are valid."""

import argparse
import importlib.util
import re
from pathlib import Path

import pytest
from keymark.operators.bridge.detector import detect_keypoints, detector_output, detector_setting
from keymark.operators.bridge.detector.detector_command import PLACEHOLDERS, parse_command


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    """The page."""
    return (repository / "docs" / "detectors.md").read_text(encoding="utf-8")


def test_every_command_is_valid(page: str) -> None:
    """Each line of an example with {clip} can be given as it stands."""
    blocks = re.split(r"^```.*\n", page, flags=re.MULTILINE)[1::2]
    lines = [line for block in blocks for line in block.splitlines() if "{clip}" in line]
    assert len(lines) >= 4
    for line in lines:
        quoted = re.search(r"--detector '(.*)'$", line)
        assert parse_command(quoted[1] if quoted else line, "docs").words


def test_every_placeholder_is_explained(page: str) -> None:
    """The table has all of them and no other."""
    table = page[page.index("| in the command |") : page.index("The program is looked for")]
    assert set(re.findall(r"`\{(\w+)\}`", table)) == set(PLACEHOLDERS)


def test_limits_are_those_of_the_code(page: str) -> None:
    """Minutes, text and files."""
    assert f"{detector_setting.DEFAULT_TIME_LIMIT_S / 60:.0f} minutes a clip" in page
    assert f"{detect_keypoints.LONGEST_SAID_BYTES // 2**20} MiB of text" in page
    assert f"{detector_output.LARGEST_BYTES // 2**30} GiB of files" in page
    assert detector_setting.VARIABLE in page


def test_options_of_the_program_that_comes_along(
    page: str, repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The table has every option but those of the example, and the program knows each."""
    file = repository / "detectors" / "mediapipe_pose.py"
    spec = importlib.util.spec_from_file_location("mediapipe_pose", file)
    assert spec is not None and spec.loader is not None
    program = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(program)
    known: set[str] = set()
    add = argparse.ArgumentParser.add_argument

    def remember(self: argparse.ArgumentParser, *names: str, **rest: object) -> object:
        known.update(name for name in names if name.startswith("--"))
        return add(self, *names, **rest)  # type: ignore[arg-type]

    monkeypatch.setattr(argparse.ArgumentParser, "add_argument", remember)
    assert program.parse(["clip.mp4", "--output", "x.json"]).model == "full"
    table = page[page.index("| option | effect |") : page.index("## Other detectors")]
    told = set(re.findall(r"(--[a-z][a-z-]+)", table))
    assert told == known - {"--output", "--frame-start", "--help"}
