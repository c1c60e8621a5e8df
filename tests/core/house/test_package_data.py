"""Files beside the Python modules that every installation needs, in the wheel and in the extension's zip."""

import ast
import tomllib
from pathlib import Path

import pytest
from keymark.core.take.examples import AEROBIC, GREETING


@pytest.fixture
def package_data(repository: Path) -> set[Path]:
    """Every file of the presets, and those beside the modules that are no Python."""
    files = {path for path in (repository / "presets").rglob("*") if path.is_file() and path.suffix != ".pyc"}
    for room in ("core", "operators"):
        found = (path for path in (repository / room).rglob("*") if path.is_file())
        files |= {path for path in found if path.suffix not in (".py", ".pyc")}
    relative = {path.relative_to(repository) for path in files}
    assert any(path.match("presets/keyframes/*.json") for path in relative)
    assert Path("presets/models/NOTICE") in relative
    assert {Path(f"presets/demo/{name}/clip.mp4") for name in (AEROBIC, GREETING)} <= relative
    assert Path("core/report/batch_page.css") in relative
    return relative


def test_the_wheel_takes_all_package_data_along(repository: Path, package_data: set[Path]) -> None:
    tree = ast.parse((repository / "setup.py").read_text(encoding="utf-8"))
    words = next(
        node for node in ast.walk(tree) if isinstance(node, ast.keyword) and node.arg == "package_data"
    )
    taken: set[Path] = set()
    for package, patterns in ast.literal_eval(words.value).items():
        folder = repository.joinpath(*package.split(".")[1:])
        taken |= {path.relative_to(repository) for pattern in patterns for path in folder.glob(pattern)}
    assert package_data - taken == set()


def test_the_extension_leaves_no_package_data_out(repository: Path, package_data: set[Path]) -> None:
    manifest = tomllib.loads((repository / "blender_manifest.toml").read_text(encoding="utf-8"))
    excluded = [pattern.strip("/") for pattern in manifest["build"]["paths_exclude_pattern"]]
    left_out = {
        path
        for path in package_data
        for pattern in excluded
        if any(part.match(pattern) for part in (path, *path.parents) if part != Path())
    }
    assert left_out == set()
