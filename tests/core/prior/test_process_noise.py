"""How the keyframes say a motion may depart from the prior."""

import numpy as np
from _scene import exercise
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.prior.frame_prior import NATURAL_SHARE, process_noise_factor

FRAMES = np.array([0, 12, 24, 36, 48])


def covariance(keyframes: Posture, time_s: np.ndarray) -> np.ndarray:
    factor = process_noise_factor(keyframes, time_s)
    return factor @ factor.T


def test_keyframes_alike_leave_the_natural_amount() -> None:
    """A body that holds still departs as every joint naturally does."""
    held = exercise(1)[np.zeros(3, dtype=np.intp)]
    found = covariance(held, np.arange(3.0))
    np.testing.assert_allclose(found, np.diag((NATURAL_SHARE * HUMAN.deviations) ** 2), atol=1e-15)


def test_twice_as_fast_departs_four_times_as_far() -> None:
    """The keyframes' part scales with the inverse square of the time between them."""
    motion = exercise(49)[FRAMES]
    natural = covariance(motion[:1], np.zeros(1))
    slow, fast = (covariance(motion, FRAMES / rate) - natural for rate in (30.0, 60.0))
    np.testing.assert_allclose(fast, 16.0 * slow, rtol=1e-6, atol=1e-15)


def test_joints_of_a_limb_move_together_and_limbs_apart() -> None:
    hip, knee = (HUMAN.dof_names.index(name) for name in ("hip.L.rotation_x", "knee.L.flexion"))
    elbow = HUMAN.dof_names.index("elbow.L.flexion")
    vector = np.zeros((5, HUMAN.dof_count))
    swing = np.array([0.0, 0.6, 0.0, 0.6, 0.0])
    vector[:, hip], vector[:, knee], vector[:, elbow] = -swing, 1.5 * swing, swing
    found = covariance(Posture.from_vector(HUMAN, vector), FRAMES / 30.0)
    spread = np.sqrt(np.diag(found))
    correlation = found / np.outer(spread, spread)
    assert correlation[hip, knee] < -0.4
    assert correlation[elbow, knee] == 0.0


def test_limbs_part_the_degrees_of_freedom() -> None:
    assert sorted(np.concatenate(HUMAN.limbs)) == list(range(HUMAN.dof_count))
    assert [len(limb) for limb in HUMAN.limbs] == [9, 3, 6, 6, 5, 5]
