"""What is open of a posture where nothing tells of it."""

import numpy as np
import pytest
from keymark.core.body.human import HUMAN
from keymark.core.estimate.keyframe_error import UNOBSERVED, unobserved_variance

SEGMENTS = ("trunk", "forearm.L", "shin.L")
TIME_S = np.arange(90) / 30.0


def open_of(visible: np.ndarray, keyframes: list[int]) -> np.ndarray:
    """(F, D) variances."""
    index = np.array(keyframes, dtype=np.intp)
    return unobserved_variance(HUMAN, SEGMENTS, visible, index, TIME_S)


@pytest.mark.parametrize("keyframes", [[0], [0, 45, 89]])
def test_nothing_is_open_where_markers_are_seen(keyframes: list[int]) -> None:
    """Nor where they are hidden for as long as limbs hide each other."""
    visible = np.ones((90, 3), dtype=bool)
    visible[30 : 29 + int(2 * 30 * UNOBSERVED.grace_s), 1] = False
    seen = [HUMAN.dof_names.index(name) for name in ("elbow.L.flexion", "knee.L.flexion", "waist.rotation_x")]
    assert open_of(visible, keyframes)[:, seen].max() == 0.0


def test_a_limb_is_open_long_after_it_was_seen_last_and_no_other() -> None:
    visible = np.ones((90, 3), dtype=bool)
    visible[20:, 1] = False
    variance = open_of(visible, [0, 80])
    elbow, knee = (variance[:, HUMAN.dof_names.index(f"{name}.L.flexion")] for name in ("elbow", "knee"))
    assert knee.max() == 0.0 and elbow[:20].max() == elbow[80] == 0.0
    assert (np.diff(elbow[28:50]) > 0.0).all() and 0.3 < np.sqrt(elbow.max()) < 1.0


def test_all_is_open_where_nothing_is_seen() -> None:
    visible = np.zeros((90, 3), dtype=bool)
    variance = open_of(visible, [0])
    assert variance[0].max() == 0.0 and (variance[89] > 0.01).all()
