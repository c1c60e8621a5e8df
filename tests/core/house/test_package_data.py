"""What is no Python and must yet come with an installation: presets, in the wheel and in the extension."""

import ast
import tomllib
from pathlib import Path

import pytest


@pytest.fixture
def presets(repository: Path) -> set[Path]:
    """Every file below presets, from the root."""
    files = {path.relative_to(repository) for path in (repository / "presets").rglob("*") if path.is_file()}
    assert any(path.match("presets/keyframes/*.json") for path in files)
    return files


def test_the_wheel_takes_all_presets_along(repository: Path, presets: set[Path]) -> None:
    """The patterns of setup.py match every one of them."""
    tree = ast.parse((repository / "setup.py").read_text(encoding="utf-8"))
    words = next(
        node for node in ast.walk(tree) if isinstance(node, ast.keyword) and node.arg == "package_data"
    )
    patterns = ast.literal_eval(words.value)["keymark"]
    taken = {path.relative_to(repository) for pattern in patterns for path in repository.glob(pattern)}
    assert presets - taken == set()


def test_the_extension_leaves_no_preset_out(repository: Path, presets: set[Path]) -> None:
    """No pattern of the manifest names a folder above them, or their kind of file."""
    manifest = tomllib.loads((repository / "blender_manifest.toml").read_text(encoding="utf-8"))
    excluded = [pattern.strip("/") for pattern in manifest["build"]["paths_exclude_pattern"]]
    left_out = {
        path
        for path in presets
        for pattern in excluded
        if any(part.match(pattern) for part in (path, *path.parents) if part != Path())
    }
    assert left_out == set()
