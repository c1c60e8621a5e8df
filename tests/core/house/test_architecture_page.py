"""The page on architecture names every room, and paths that exist."""

import re
from pathlib import Path

import pytest

PATH = re.compile(r"(?:core|operators|tests|presets|tools|benchmarks|docs)/[\w/.]*\w")


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    return (repository / "docs" / "architecture.md").read_text(encoding="utf-8")


def test_every_path_exists(repository: Path, page: str) -> None:
    named = set(PATH.findall(page))
    assert len(named) > 8
    assert [name for name in sorted(named) if not (repository / name).exists()] == []


def test_rooms_are_those_of_the_tree(repository: Path, page: str) -> None:
    tree = page.split("```")[1]
    for top, section in zip(
        ("core", "operators"), re.split(r"^operators/", tree, flags=re.MULTILINE), strict=True
    ):
        section = section.split("\npresets/")[0]
        named = {name for line in re.findall(r"^   (?=\w)(.*?)(?:   |$)", section, flags=re.MULTILINE)
                 for name in re.findall(r"(\w+)/", line)}  # fmt: skip
        assert named == {path.parent.name for path in (repository / top).glob("*/__init__.py")}
