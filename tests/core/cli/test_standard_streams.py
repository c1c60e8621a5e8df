"""Standard streams that are closed, or have a narrow encoding."""

import sys
from io import BytesIO, TextIOWrapper
from pathlib import Path

import pytest
from _synthetic_take import write_synthetic_take
from keymark.operators.cli.blender_silence import blender_silence
from keymark.operators.cli.main import main


def test_a_process_without_standard_streams_does_its_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    take = write_synthetic_take(tmp_path / "take", 8)
    for stream in ("stdin", "stdout", "stderr"):
        monkeypatch.setattr(sys, stream, None)
    assert main(["propose", str(take), "--count", "4"]) == 0
    assert main(["propose", str(take), "--count", "1"]) == 2


def test_blender_may_print_any_path(monkeypatch: pytest.MonkeyPatch) -> None:
    with TextIOWrapper(BytesIO(), encoding="ascii") as stream:
        monkeypatch.setattr(sys, "stdout", stream)
        with blender_silence(debug=False):
            print("舞者")
        with pytest.raises(UnicodeEncodeError):
            print("舞者")
