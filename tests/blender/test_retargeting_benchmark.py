"""The benchmark of retargeting: both methods are measured by the same figures."""

import sys

import numpy as np
import pytest
from _armatures import build_character
from _boot import ROOT
from _characters import plain_character
from _synthetic_take import BODY, true_postures
from keymark.core.take.motion import Motion

sys.path.insert(0, str(ROOT / "benchmarks"))

import retargeting  # noqa: E402

FRAMES = 24


@pytest.fixture(scope="module")
def found() -> dict[str, retargeting.Row]:
    """The figures of a swaying performer on a character whose arms hang at rest."""
    posture = true_postures(FRAMES)
    points = BODY.points(BODY.pose(posture))
    unknown = np.full((FRAMES, 13, 3, 3), np.nan)
    motion = Motion(BODY, 30.0, 1, np.arange(FRAMES) / 30.0, posture, points, unknown, (0,), "map")
    return retargeting.measured(lambda: build_character(plain_character(arms_down_deg=60.0)), motion)


def test_copied_rotations_keep_the_difference_of_the_rest_poses(found: dict[str, retargeting.Row]) -> None:
    own, copied = (found[method] for method in retargeting.METHODS)
    assert copied["arms_deg"] == pytest.approx(60.0, abs=5.0)
    assert own["arms_deg"] < 2.0
    assert copied["keys_share"] == 100.0 and own["keys_share"] < 60.0


def test_a_row_has_means_and_the_worst_where_it_counts(found: dict[str, retargeting.Row]) -> None:
    own = found[retargeting.METHODS[0]]
    # A figure that no measured time can have by chance.
    worse = own | {"penetration_mm": 98765.4, "legs_deg": own["legs_deg"] + 1.0}
    row = retargeting.summary([own, worse])
    assert row["penetration_mm"] == 98765.4 and row["legs_deg"] == pytest.approx(own["legs_deg"] + 0.5)
    lines = retargeting.table({"plain": {name: [row] for name, row in found.items()}})
    assert len(lines) == 2 + len(retargeting.METHODS) and "98765" not in lines[2]
