"""The computations of the workflow's benchmarks."""

import sys

import numpy as np
import pytest
from _boot import ROOT
from _synthetic_take import write_synthetic_take

sys.path.insert(0, str(ROOT / "benchmarks"))

import finishing  # noqa: E402
from keyframing import exact_postures  # noqa: E402
from takes import group_of  # noqa: E402
from trials import Trial, read_trial  # noqa: E402

FRAMES = 24


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    """A small synthetic take with its tracks and its truth."""
    return read_trial(write_synthetic_take(tmp_path_factory.mktemp("workflow") / "take", FRAMES))


def test_a_tighter_tolerance_costs_more_keys(trial: Trial) -> None:
    row = finishing.finished(trial, exact_postures(trial))
    assert row["keyframes"] <= row["reduced 20"] <= row["reduced 5"]
    assert row["keyframes"] <= row["even 20"] <= row["even 5"]
    body, times = trial.take.body, np.arange(FRAMES, dtype=np.float64)
    rig = finishing.quaternion_rig(body)
    values = finishing.rig_values(rig, exact_postures(trial), body)
    posed = np.array(trial.take.keyframe_indices)
    assert row["even 5"] < finishing.even_keys(rig, times, values, posed, 2e-4) <= FRAMES
    assert row["mpjpe"] < 0.1 and row["baked"] <= finishing.BAKED_MM
    assert "| take |" in finishing.table({"take": row}, {}, finishing.COLUMNS)[0]


def test_takes_are_grouped_by_folder(trial: Trial) -> None:
    assert group_of(ROOT / "presets" / "demo" / "aerobic") == "given"
    assert group_of(trial.take.folder) == "studio"
