"""Two-bone inverse kinematics: goals, lengths, hinges, and limits of reach."""

import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.body import rotations
from keymark.core.body.rotations import exponential
from keymark.core.retarget.solve.two_bone import LimbPose, reach_for, stretched_m, unit

UPPER_M, LOWER_M = 0.4, 0.35


def leg(flexion_rad: Array) -> LimbPose:
    """A leg that hangs from the origin and bends its knee forward."""
    count = len(flexion_rad)
    hinge = np.array([1.0, 0.0, 0.0])
    upper = np.broadcast_to(np.eye(3), (count, 3, 3))
    lower = exponential(flexion_rad[:, None] * hinge)
    middle = np.tile([0.0, 0.0, -UPPER_M], (count, 1))
    end = middle + lower @ [0.0, 0.0, -LOWER_M]
    return LimbPose(upper, lower, np.zeros((count, 3)), middle, end, np.tile(hinge, (count, 1)))


def test_a_limb_reaches_its_goal_and_keeps_its_lengths() -> None:
    rng = np.random.default_rng(3)
    goal = rng.uniform(0.15, 0.7, (50, 1)) * unit(rng.normal(size=(50, 3)))
    solved = reach_for(leg(np.full(50, 0.5)), np.zeros((50, 3)), goal)
    np.testing.assert_allclose(solved.end, goal, atol=1e-9)
    np.testing.assert_allclose(solved.upper_turn @ [0.0, 0.0, -UPPER_M], solved.middle, atol=1e-9)
    np.testing.assert_allclose(
        solved.lower_turn @ [0.0, 0.0, -LOWER_M], solved.end - solved.middle, atol=1e-9
    )


def test_a_limb_that_is_where_it_shall_be_stays_and_a_straight_one_knows_where_it_bends() -> None:
    limb = leg(np.linspace(0.05, 2.4, 40))
    solved = reach_for(limb, limb.start, limb.end)
    np.testing.assert_allclose(solved.upper_turn, limb.upper_turn, atol=1e-6)
    np.testing.assert_allclose(solved.middle, limb.middle, atol=1e-6)
    limb = leg(np.zeros(3))
    solved = reach_for(limb, limb.start, limb.end * (1.0 - np.array([[1e-3], [1e-2], [1e-1]])))
    np.testing.assert_allclose(unit(solved.middle * [1.0, 1.0, 0.0]), [[0.0, -1.0, 0.0]] * 3, atol=1e-6)
    np.testing.assert_allclose(limb.bend, [[0.0, -1.0, 0.0]] * 3, atol=1e-9)


def test_a_goal_that_leaves_the_reach_stretches_the_limb_smoothly_or_as_the_performers() -> None:
    wanted = np.linspace(0.5, 1.2, 500)
    extension = stretched_m(wanted, np.zeros(500), 0.75)
    assert (np.diff(extension) >= 0.0).all() and extension.max() < 0.75
    assert np.abs(np.diff(extension, 2)).max() < 1e-4
    np.testing.assert_allclose(extension[wanted < 0.7], wanted[wanted < 0.7])
    wanted = np.array([0.74, 0.745])
    np.testing.assert_allclose(stretched_m(wanted, np.full(2, 0.748), 0.75), wanted)


@pytest.mark.parametrize("target", [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.6, 0.0, -0.8]])
def test_smallest_rotations(target: list[float]) -> None:
    source = np.array([1.0, 0.0, 0.0])
    turn = rotations.smallest(source, np.array(target))
    np.testing.assert_allclose(turn @ source, target, atol=1e-9)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(turn) > 0.0
