"""What every test shares: the package under its name, the takes, and which rooms can run here."""

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parent
sys.path.insert(0, str(TESTS))

from _boot import ROOT, load_package  # noqa: E402

load_package()

try:
    from hypothesis import settings
except ImportError:  # a real Blender may lack it; what needs it is then not collected
    pass
else:  # the same examples in every run, however slow the machine is
    settings.register_profile("repeatable", deadline=None, derandomize=True)
    settings.load_profile("repeatable")

HAS_BLENDER = importlib.util.find_spec("bpy") is not None
collect_ignore_glob = [] if HAS_BLENDER else ["blender/*"]


def pytest_report_header() -> str:
    """Name the Blender the tests run in, so that a run without one cannot pass for a run in it."""
    if not HAS_BLENDER:
        return "blender: none here, tests/blender is left out"
    import bpy

    return f"blender: {bpy.app.version_string}"


@pytest.fixture(scope="session")
def repository() -> Path:
    """The repository's root folder."""
    return ROOT


@pytest.fixture(scope="session")
def shared_takes() -> Path:
    """The folder of takes with truth that lies beside the repository; skips where there is none."""
    folder = ROOT.parent / "shared" / "takes"
    if not folder.is_dir():
        pytest.skip("no shared/takes beside the repository")
    return folder


@pytest.fixture(scope="session")
def take_folder(shared_takes: Path) -> Callable[[str], Path]:
    """A function from the name of a shared take to its folder; skips where that take is missing."""

    def folder(name: str) -> Path:
        take = shared_takes / name
        if not (take / "take.json").is_file():
            pytest.skip(f"no take {name} in shared/takes")
        return take

    return folder
