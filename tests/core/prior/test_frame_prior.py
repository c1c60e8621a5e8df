"""What keyframes say of the frames between them: how far a motion departs, and what one frame looks like."""

import numpy as np
from _scene import exercise
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.prior.frame_prior import (
    NATURAL_SHARE,
    difference_std,
    prior_from_keyframes,
    prior_from_pose,
    process_noise_factor,
)
from keymark.core.prior.keyframes import Keyframe

TRUTH = exercise(60)
KEYFRAMES = tuple(Keyframe(frame, TRUTH[frame]) for frame in (0, 20, 50))


def test_postures_differ_more_the_longer_the_time_between() -> None:
    stds = [difference_std(HUMAN, time_s) for time_s in (0.0, 0.1, 0.5, 2.0, 10.0)]
    assert all(np.all(later >= earlier) for earlier, later in zip(stds, stds[1:], strict=False))
    assert stds[0].max() < 0.01
    assert np.all(stds[4][:3] > 2.0 * stds[3][:3])
    assert stds[4][6:].max() < 1.0


def test_the_nearest_keyframe_is_believed_beyond_the_ends() -> None:
    prior = prior_from_keyframes(KEYFRAMES, 65, 30.0)
    step = prior.posture.minus(TRUTH[50])
    assert np.abs(step[2:]).max() < 1e-12
    way = TRUTH[50].translation - TRUTH[20].translation
    np.testing.assert_allclose(step[:2], 0.5 * 0.5 * way[:2])
    assert prior.starts.batch == (1,)


def test_a_single_keyframe_goes_nowhere() -> None:
    prior = prior_from_keyframes(KEYFRAMES[:1], 30, 30.0)
    assert np.abs(prior.posture.minus(TRUTH[0])).max() < 1e-12


def test_between_two_both_count_and_more_surely() -> None:
    prior = prior_from_keyframes(KEYFRAMES, 32, 30.0)
    alone = prior_from_keyframes(KEYFRAMES[:2], 32, 30.0)
    assert np.all(prior.std < alone.std)
    assert prior.starts.batch == (3,)
    assert np.abs(prior.starts[1].minus(TRUTH[20])).max() < 1e-12
    assert np.abs(prior.starts[2].minus(TRUTH[50])).max() < 1e-12


def test_a_keyframe_at_the_frame_itself_does_not_decide() -> None:
    prior = prior_from_keyframes(KEYFRAMES, 20, 30.0)
    assert np.abs(prior.posture.minus(TRUTH[20])).max() > 0.05
    alone = prior_from_keyframes(KEYFRAMES[1:2], 20, 30.0)
    assert np.abs(alone.posture.minus(TRUTH[20])).max() < 1e-12


def test_a_pose_is_believed_as_it_stands() -> None:
    prior = prior_from_pose(TRUTH[3])
    assert np.abs(prior.starts[0].minus(TRUTH[3])).max() < 1e-12
    assert np.all(prior.std > 0.0)


FRAMES = np.array([0, 12, 24, 36, 48])


def covariance(keyframes: Posture, time_s: np.ndarray) -> np.ndarray:
    factor = process_noise_factor(keyframes, time_s)
    return factor @ factor.T


def test_keyframes_alike_leave_the_natural_amount() -> None:
    held = exercise(1)[np.zeros(3, dtype=np.intp)]
    found = covariance(held, np.arange(3.0))
    np.testing.assert_allclose(found, np.diag((NATURAL_SHARE * HUMAN.deviations) ** 2), atol=1e-15)


def test_twice_as_fast_departs_four_times_as_far() -> None:
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
