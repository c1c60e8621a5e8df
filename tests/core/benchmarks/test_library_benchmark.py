"""The computations of the benchmark of keyframe libraries."""

import sys
from dataclasses import replace

import pytest
from _boot import ROOT
from _synthetic_take import write_synthetic_take

sys.path.insert(0, str(ROOT / "benchmarks"))

import matching as bench  # noqa: E402
from keymark.core.library.library_file import read_library  # noqa: E402
from keymark.core.library.registry import SHIPPED  # noqa: E402
from trials import Trial, read_unposed  # noqa: E402


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """A small synthetic take, read without its keyframes."""
    return read_unposed(write_synthetic_take(tmp_path_factory.mktemp("libraries") / "take", 24))


def test_every_library_that_fits_a_take_is_shipped() -> None:
    """Otherwise a wrong name would surface only when its take is measured."""
    shipped = {path.stem for path in SHIPPED.glob("*.json")}
    assert set(bench.FITTING.values()) <= shipped


def test_posed_keyframes_are_not_used(trial: Trial) -> None:
    """Neither as a keyframe nor for tracking markers, and every frame is scored."""
    assert trial.take.keyframes == () and trial.unscored == ()


def test_a_take_is_measured_without_and_with_two_keyframes(trial: Trial) -> None:
    """Exactly posed frames are not scored, and the table has the ratios in its header."""
    found = bench.measure("waves", trial, read_library(SHIPPED / "waving.json"))
    assert (found.unposed.keyframes, found.two.keyframes, found.both.keyframes) == (0, 2, 2)
    assert found.unposed.coverage95 is not None and found.matching_ms > 0.0
    better = replace(found, both=replace(found.both, mpjpe=0.4 * found.two.mpjpe))
    assert "| 0.40 |" in bench.accuracy_table({"waves": better})
