"""The benchmarks' search for takes."""

import importlib.util
import os
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture
def takes(repository: Path) -> ModuleType:
    """The module benchmarks/takes.py."""
    spec = importlib.util.spec_from_file_location("benchmark_takes", repository / "benchmarks" / "takes.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_folders_named_in_the_environment_are_found(
    takes: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("first/hop", "second/skip", "second/untrue"):
        (tmp_path / name).mkdir(parents=True)
        if "untrue" not in name:
            (tmp_path / name / "truth.json").write_text("{}", encoding="utf-8")
    before = takes.take_names()
    folders = [str(tmp_path / "first"), str(tmp_path / "second")]
    monkeypatch.setenv("KEYMARK_TAKES", os.pathsep.join(folders))
    found = takes.take_names()
    assert {name for name in found if name not in before} == {"hop", "skip"}
    assert found["skip"] == tmp_path / "second" / "skip"
    assert "demo/aerobic" in found


def test_takes_without_markers_come_on_request(takes: ModuleType) -> None:
    assert "demo/greeting" not in takes.take_names()
    assert {"demo/greeting", "demo/aerobic"} <= set(takes.take_names(plain=True))
