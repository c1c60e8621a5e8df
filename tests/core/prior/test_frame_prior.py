"""What is believed of a frame before its picture is looked at."""

import numpy as np
from _scene import exercise
from keymark.core.body.human import HUMAN
from keymark.core.prior.frame_prior import difference_std, prior_from_keyframes, prior_from_pose
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
    """After the last one only the way across the floor goes on, at half its pace."""
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
