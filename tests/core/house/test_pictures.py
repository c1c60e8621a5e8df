"""Every picture of the docs is in the script's table, and every picture of the table is shown."""

import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools"))

from pictures.table import ALL, SCREENSHOTS  # noqa: E402

SHOWN = re.compile(r"!\[[^\]]+\]\(((?:\.\./)?[\w./-]*pictures/[\w.-]+)\)")
LARGEST_BYTES = {"filming_": 80_000, "keymark.webp": 2_500_000, "": 200_000}
"""By the beginning of a name, the first that fits."""


def shown_pictures(repository: Path) -> dict[Path, list[str]]:
    """The pages that show each picture."""
    shown: dict[Path, list[str]] = {}
    for page in (repository / "README.md", *sorted((repository / "docs").glob("*.md"))):
        for name in SHOWN.findall(page.read_text(encoding="utf-8")):
            shown.setdefault((page.parent / name).resolve(), []).append(page.name)
    return shown


def test_pages_show_what_the_script_makes(repository: Path) -> None:
    shown = {file.name for file in shown_pictures(repository)}
    assert len(shown) > 25
    assert shown == set(ALL)
    assert len(set(ALL)) == len(ALL)


def test_pictures_are_there_and_small(repository: Path) -> None:
    folder = repository / "docs" / "pictures"
    assert {file.parent for file in shown_pictures(repository)} == {folder}
    assert {file.name for file in folder.iterdir()} == set(ALL)
    for name in ALL:
        most = next(size for begin, size in LARGEST_BYTES.items() if name.startswith(begin))
        assert 5_000 < (folder / name).stat().st_size <= most, name


def test_sessions_take_the_screenshots(repository: Path) -> None:
    scripts = repository / "tests" / "real_blender" / "ui"
    steps = "\n".join(file.read_text(encoding="utf-8") for file in scripts.glob("*.py"))
    for name, screenshot in SCREENSHOTS.items():
        taken = re.search(rf'(\.look|\.shoot|seen)\((person, )?"{screenshot.name}"', steps)
        assert taken, f"{name}: no session takes `{screenshot.name}`"
        assert f'"{screenshot.session}"' in (scripts / "test_ui.py").read_text(encoding="utf-8"), name
