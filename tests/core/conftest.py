"""Stand-ins that several tests of the core and the command line share."""

from pathlib import Path

import pytest
from keymark.core.take.conversion_record import BLEND, BVH
from keymark.operators.cli.conversion import convert_take


@pytest.fixture
def no_blender(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two files with no content in place of what Blender writes; tests/blender has the real ones."""

    def write(_take: object, _motion: object, staging_folder: Path, _output: Path, _debug: bool) -> str:
        for name in (BLEND, BVH):
            (staging_folder / name).touch()
        return "0" * 64

    monkeypatch.setattr(convert_take, "require_blender", lambda needing: None)
    monkeypatch.setattr(convert_take, "write_blender_files", write)
