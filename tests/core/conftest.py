"""Stand-ins that several tests of the core and the command line share."""

from pathlib import Path

import pytest
from keymark.operators.command_line.conversion import unit


@pytest.fixture
def no_blender(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two files with no content in place of what Blender writes; tests/blender has the real ones."""

    def write(_take: object, _motion: object, place: Path, _output: Path, _debug: bool) -> str:
        for name in (unit.BLEND, unit.BVH):
            (place / name).touch()
        return "0" * 64

    monkeypatch.setattr(unit, "require_blender", lambda what: None)
    monkeypatch.setattr(unit, "_write_scene", write)
