"""Whole turns added to interpolated keyframes."""

import numpy as np
from _scene import BODY, exercise
from keymark.core.body.posture import Posture, headings_rad, yawed_at
from keymark.core.prior.keyframes import Keyframe, heading_steps_rad, interpolate, with_turns

KEYFRAMES = np.array([5, 15, 30, 40])
FRAMES = 48


def posed() -> Posture:
    """Four postures that face 0, 20, 166 and 180 degrees."""
    still = exercise(4)
    return yawed_at(still, np.radians([0.0, 20.0, 166.0, 180.0]) - headings_rad(still), still.translation)


def prior() -> Posture:
    """The short way round: 146 degrees in the middle."""
    keys = tuple(Keyframe(int(k), posture) for k, posture in zip(KEYFRAMES, posed(), strict=True))
    return interpolate(keys, FRAMES)


def test_the_other_way_round_passes_through_the_same_keyframes() -> None:
    """It turns by -214 degrees instead of 146, evenly, and keeps place, joints and what lies farther away."""
    short, long = prior(), with_turns(prior(), KEYFRAMES, np.array([0, -1, 0]))
    np.testing.assert_allclose(long[KEYFRAMES].rotations, short[KEYFRAMES].rotations, atol=1e-9)
    heading = np.unwrap(headings_rad(long))
    np.testing.assert_allclose(np.degrees(heading[30] - heading[15]), -214.0, atol=1e-6)
    steps = np.degrees(np.diff(heading[15:31]))
    assert steps.max() < 0.0 and steps.min() > 2.5 * -214.0 / 15
    assert np.abs(np.degrees(np.diff(heading, n=2))).max() < 12.0  # no jump in speed at the keyframes
    np.testing.assert_array_equal(long.translation, short.translation)
    np.testing.assert_array_equal(long.rotations[:, 1:], short.rotations[:, 1:])
    np.testing.assert_array_equal(long.rotations[:6], short.rotations[:6])
    np.testing.assert_array_equal(long.rotations[40:], short.rotations[40:])


def test_a_whole_turn_more_is_seen_on_the_way_only() -> None:
    """Points of the body circle once more; none added is the same object."""
    short = prior()
    assert with_turns(short, KEYFRAMES, np.zeros(3, dtype=np.intp)) is short
    heading = np.unwrap(headings_rad(with_turns(short, KEYFRAMES, np.array([0, 1, 0]))))
    np.testing.assert_allclose(np.degrees(heading[30] - heading[15]), 506.0, atol=1e-6)
    both = with_turns(short, KEYFRAMES, np.array([1, -1, 0]))
    points = BODY.points(BODY.pose(both))
    np.testing.assert_allclose(points[KEYFRAMES], BODY.points(BODY.pose(short))[KEYFRAMES], atol=1e-9)


def test_steps_between_keyframes_are_taken_the_short_way() -> None:
    """From -180 to 180 degrees, across the cut as well."""
    np.testing.assert_allclose(np.degrees(heading_steps_rad(posed())), [20.0, 146.0, 14.0], atol=1e-6)
    behind = yawed_at(posed(), np.radians(170.0), posed().translation)
    np.testing.assert_allclose(np.degrees(heading_steps_rad(behind)), [20.0, 146.0, 14.0], atol=1e-6)
