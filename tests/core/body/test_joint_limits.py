"""The joint limits of the default body."""

import numpy as np
import pytest
from keymark.core.body.human import HUMAN, joint_limits_deg
from keymark.core.body.mirror import mirrored
from keymark.core.body.posture import Posture

LIMITED = np.flatnonzero(np.isfinite(HUMAN.limits[:, 0]))


@pytest.mark.parametrize("bound", [0, 1])
def test_both_sides_have_the_same_range_of_motion(bound: int) -> None:
    """The mirror image of a posture with one degree of freedom at its limit has one at its limit too."""
    vectors = np.zeros((len(LIMITED), HUMAN.dof_count))
    vectors[np.arange(len(LIMITED)), LIMITED] = HUMAN.limits[LIMITED, bound]
    other = mirrored(Posture.from_vector(HUMAN, vectors)).to_vector()
    at_limit = np.isclose(other[:, LIMITED, None], HUMAN.limits[LIMITED]).any(axis=-1)
    np.testing.assert_array_equal(at_limit.sum(axis=1), 1)


def test_an_unknown_joint_has_no_limits() -> None:
    """A misspelled joint is an error, not a free one."""
    with pytest.raises(KeyError):
        joint_limits_deg("wrist.L")
