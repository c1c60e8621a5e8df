"""Library files: nothing lost, nothing trusted."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from _libraries import small_library
from _library_strategies import libraries
from hypothesis import HealthCheck, given, settings
from keymark.core.prior.library import Library, read_library, write_library


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "small_steps.json"
    write_library(path, small_library())
    return path


def assert_same(first: Library, second: Library, tolerance: float) -> None:
    """Both hold the same, numbers within a tolerance."""
    for name in ("identifier", "title", "version", "author", "license", "description", "sources", "tags"):
        assert getattr(first, name) == getattr(second, name)
    assert first.actor.segments_m == pytest.approx(dict(second.actor.segments_m), abs=tolerance)
    for one, other in zip(first.postures, second.postures, strict=True):
        assert (one.name, one.tags) == (other.name, other.tags)
        np.testing.assert_allclose(one.posture.translation, other.posture.translation, atol=tolerance)
        np.testing.assert_allclose(one.posture.rotations, other.posture.rotations, atol=4.0 * tolerance)
        np.testing.assert_allclose(one.posture.angles, other.posture.angles, atol=tolerance)
    for mine, theirs in zip(first.motions, second.motions, strict=True):
        assert (mine.name, mine.cyclic) == (theirs.name, theirs.cyclic)
        assert [step.posture for step in mine.steps] == [step.posture for step in theirs.steps]
        times = [step.time_s for step in theirs.steps]
        assert [step.time_s for step in mine.steps] == pytest.approx(times, abs=tolerance)
        assert (*mine.travel, mine.duration_s) == pytest.approx(
            (*theirs.travel, theirs.duration_s), abs=tolerance
        )


@settings(max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(libraries())
def test_nothing_is_lost_and_the_second_time_nothing_changes(library: Library) -> None:
    """What is written is read back to nine decimals, and from then on to the last bit."""
    value = library.to_json()
    back = Library.from_json(value, "here")
    assert_same(back, library, 3e-9)  # half a turn is kept two nanoradians short
    assert back.to_json() == value
    assert_same(Library.from_json(back.to_json(), "here"), back, 0.0)


def test_a_way_too_short_for_the_file_leaves_none() -> None:
    """Else it would stand there as zeros once, and be gone the next time."""
    library = small_library()
    cycle = next(motion for motion in library.motions if motion.cyclic)
    value = replace(library, motions=(replace(cycle, travel=(1e-12, 0.0, -1e-12)),)).to_json()
    assert "travel" not in value["motions"][0]


def test_a_file_that_is_read_and_written_has_the_same_bytes(file: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.json"
    write_library(again, read_library(file))
    assert again.read_bytes() == file.read_bytes()
    assert file.read_bytes().endswith(b"}\n")


def test_a_small_change_is_a_small_difference(file: Path, tmp_path: Path) -> None:
    text = file.read_text(encoding="utf-8")
    assert '\n        "knee.L.flexion": ' in text
    assert '{"time_s": 0.31, "posture": "Stand on one leg"}' in text
    assert max(len(line) for line in text.splitlines()) < 140
