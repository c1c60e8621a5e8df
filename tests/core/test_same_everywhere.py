"""The same take gives the same motion: bit for bit here, and to a tenth of a millimeter anywhere."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

TOLERANCE_M = 1e-4
"""Between the supported versions of Blender, Python and numpy."""


@pytest.fixture(scope="module")
def golden(repository: Path) -> ModuleType:
    """The module that reads and makes the file."""
    spec = importlib.util.spec_from_file_location("demo_points", repository / "tests/golden/demo_points.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_demonstration_moves_as_it_did(golden: ModuleType) -> None:
    first, again = golden.demo_points(), golden.demo_points()
    assert first.tobytes() == again.tobytes()
    difference = np.abs(first - golden.golden_points()).max()
    assert difference < TOLERANCE_M, f"{1000 * difference:.4f} mm off in Python {sys.version.split()[0]}"
