"""Two of the shipped libraries."""

from pathlib import Path

import pytest
from keymark.core.prior.library import Library, read_library


@pytest.fixture(scope="package")
def walking(repository: Path) -> Library:
    return read_library(repository / "presets" / "keyframes" / "walking.json")


@pytest.fixture(scope="package")
def squatting(repository: Path) -> Library:
    return read_library(repository / "presets" / "keyframes" / "squatting_lifting.json")
