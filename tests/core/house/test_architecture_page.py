"""The page on architecture names modules that exist, types where they are, and every room."""

import re
from pathlib import Path

import pytest

PATH = re.compile(r"^(core|operators|tests|presets|tools|benchmarks|docs)/[\w/.]+$")


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    """The page."""
    return (repository / "docs" / "architecture.md").read_text(encoding="utf-8")


def module_file(root: Path, path: str) -> Path | None:
    """The file or folder that a path of the page stands for; None where there is none."""
    candidates = (root / path, root / f"{path}.py")
    return next((file for file in candidates if file.exists()), None)


def test_every_path_exists(repository: Path, page: str) -> None:
    """A module that is renamed is renamed on the page."""
    named = [name for name in re.findall(r"`([^`\n]+)`", page) if PATH.match(name)]
    assert len(named) > 60
    assert [name for name in named if module_file(repository, name) is None] == []


def test_every_type_is_defined_where_the_page_says(repository: Path, page: str) -> None:
    """Each type of the table is defined in one of the modules beside it."""
    rows = re.findall(r"^\| (`[A-Z]\w+`(?:, `[A-Z]\w+`)*) \| ([^|]+) \|", page, flags=re.MULTILINE)
    assert len(rows) > 25
    for types, where in rows:
        paths = [module_file(repository, name) for name in re.findall(r"`([^`]+)`", where)]
        files = [file for path in paths if path for file in (path.glob("*.py") if path.is_dir() else [path])]
        source = "\n".join(file.read_text(encoding="utf-8") for file in files)
        for name in re.findall(r"`(\w+)`", types):
            assert re.search(rf"^(class {name}\b|{name} = )", source, flags=re.MULTILINE), name


def test_every_room_is_named(repository: Path, page: str) -> None:
    """Every folder of core and of operators has its line in the list of rooms."""
    tree = page[page.index("## Rooms") : page.index("## Conventions")]
    rooms = [
        folder.name
        for top in ("core", "operators")
        for folder in (repository / top).iterdir()
        if (folder / "__init__.py").is_file()
    ]
    assert len(rooms) > 20
    assert [room for room in rooms if f" {room}/" not in tree] == []
