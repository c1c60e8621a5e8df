"""Fingers: curls of points, of a performer's bones, and of both from each other."""

import numpy as np
import pytest
from keymark.core.body.fingers import (
    FINGER_BONES,
    RELAXED_RAD,
    RESTING,
    Hands,
    curls_of,
    finger_bones,
    finger_flexions,
    finger_turns,
    palm_of,
)
from keymark.core.body.rotations import exponential
from keymark.core.body.skeleton import FINGERS

CURLS = np.array([0.5, 0.6, 1.2, 0.8, 1.0])
OF_THE_THUMB = [0.037, 0.0, 0.0, 0.0, 0.0]
"""Its first joint lies 8 degrees beside the line that its bones go on, in the skin too."""
TO_MIDDLE_DEG = 9.5
"""From the hand's bone to the middle knuckle, in the palm."""


def hands(frames: int = 3) -> Hands:
    """Both hands closed by `CURLS`, the right one half as far."""
    curls = np.broadcast_to(np.stack([CURLS, 0.5 * CURLS]), (frames, 2, len(FINGERS)))
    return Hands(curls, np.zeros((frames, 2, 3)), np.ones((frames, 2)))


@pytest.mark.parametrize(("side", "share"), [("L", 1.0), ("R", 0.5)])
def test_points_of_bent_fingers_have_their_curls(side: str, share: float) -> None:
    turns, points = finger_turns(hands()), [np.zeros(3)]
    for name, start, end, _ in finger_bones(side):
        if ".1." in name:
            turn, at = np.eye(3), start
            points.append(at)
        turn = turn @ turns[name][0]
        at = at + turn @ (end - start)
        points.append(at)
    seen = exponential(np.array([0.3, -0.8, 0.5]))
    found = curls_of(np.array(points) @ seen.T)
    np.testing.assert_allclose(found, share * CURLS + OF_THE_THUMB, atol=0.012)
    palm = RESTING[side].T @ palm_of(np.array(points), side)
    np.testing.assert_allclose(palm[:, 2], [0.0, 0.0, 1.0], atol=1e-9)
    assert np.degrees(np.arctan2(palm[1, 0], palm[0, 0])) == pytest.approx(TO_MIDDLE_DEG, abs=0.1)
    tips = np.array(points)[[8, 12, 16, 20]]
    assert (tips[:, 2] < 0.0).all(), "fingers bend toward the palm, which is down"


def test_flexions_are_those_that_turned_the_bones_and_need_all_three() -> None:
    turns = finger_turns(hands())
    assert set(turns) == set(FINGER_BONES)
    flexions = finger_flexions({name: turn for name, turn in turns.items() if name != "ring.2.R"})
    assert set(flexions) == {f"{finger}.{side}" for side in "LR" for finger in FINGERS} - {"ring.R"}
    np.testing.assert_allclose(flexions["middle.L"].mean(axis=-1), CURLS[2])
    np.testing.assert_allclose(flexions["pinky.R"].mean(axis=-1), 0.5 * CURLS[4])
    first, second, third = flexions["middle.L"][0]
    assert second > first > third > 0.5 * first


def test_some_frames_of_hands() -> None:
    own = hands(4)
    assert own[1:3].curls.shape == (2, 2, 5)
    np.testing.assert_array_equal(own[np.array([2, 2])].sure, np.ones((2, 2)))
    assert np.degrees(RELAXED_RAD).min() > 15.0
