"""Stand-ins that several tests of the core and the command line share."""

from pathlib import Path

import pytest
from keymark.operators.command_line import conversion


@pytest.fixture
def no_blender(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two files with no content in place of what Blender writes; tests/blender has the real ones."""

    def write(_take: object, _motion: object, place: Path, _output: Path, _debug: bool) -> str:
        for name in (conversion.BLEND, conversion.BVH):
            (place / name).touch()
        return "0" * 64

    monkeypatch.setattr(conversion, "require_blender", lambda what: None)
    monkeypatch.setattr(conversion, "_write_scene", write)
