"""`keymark library blend` and `read`: a library through Blender's pose assets and back."""

import json
from pathlib import Path

import pytest
from _libraries import small_library
from keymark.core.prior.library import write_library
from keymark.operators.bridge.asset_catalogs import NAME
from keymark.operators.cli.main import main


@pytest.fixture
def library(tmp_path: Path) -> Path:
    write_library(tmp_path / "small_steps.json", small_library())
    return tmp_path / "small_steps.json"


def test_a_library_survives_its_way_through_a_blend(
    library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "assets"
    assert main(["library", "blend", str(library), "--output", str(folder), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    blend = folder / "small_steps.blend"
    assert said["files"] == [str(blend), str(folder / NAME)] and all(
        Path(file).is_file() for file in said["files"]
    )
    again = tmp_path / "again.json"
    assert main(["library", "read", str(blend), "--output", str(again), "--quiet"]) == 0
    assert again.read_bytes() == library.read_bytes()


def test_nothing_is_replaced_unless_told(
    library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "assets"
    folder.mkdir()
    (folder / "small_steps.blend").write_text("mine", encoding="utf-8")
    words = ["library", "blend", str(library), "--output", str(folder), "--quiet"]
    assert main(words) == 2
    assert (folder / "small_steps.blend").read_text(encoding="utf-8") == "mine"
    assert main(["library", "read", str(library), "--output", str(tmp_path / "x.json"), "--quiet"]) == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 2 and "--replace" in said[0] and "no .blend" in said[1]
    assert main([*words, "--replace"]) == 0
