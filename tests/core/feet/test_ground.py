"""The performer's ground: levels of rests, steps, and the scene's own ground."""

import numpy as np
from _performances import performance, stepping, steps
from keymark.core.body.kinematics import SegmentMotion
from keymark.core.body.posture import Posture
from keymark.core.feet.contacts import Contact
from keymark.core.feet.ground import CHANGE_S, Ground, _under
from keymark.core.retarget.solve.feet import performer_ground


def raised(*heights_m: float) -> SegmentMotion:
    """The steps one after the other, each time elsewhere and on another height."""
    body, posture = stepping()
    parts = [
        Posture(posture.skeleton, posture.translation + [2.0 * n, 0.0, h], posture.rotations, posture.angles)
        for n, h in enumerate(heights_m)
    ]
    return performance(body, Posture.concatenate(parts))


def levels_m(ground: Ground) -> list[float]:
    """Height of the ground at each rest."""
    return [
        float(np.median(ground.height_m[rest.first : rest.last + 1, rest.point])) for rest in ground.rests
    ]


def test_rests_on_the_scenes_ground_are_on_it() -> None:
    ground = performer_ground(steps())
    assert set(levels_m(ground)) == {0.0}
    assert not ground.height_m.any()
    assert 0.06 < ground.ankle_m < 0.09


def test_steps_keep_their_heights() -> None:
    ground = performer_ground(raised(0.0, 0.2))
    levels = np.unique(np.round(levels_m(ground), 6))
    assert len(levels) == 2 and levels[0] == 0.0
    assert abs(levels[1] - 0.2) < 0.02
    assert ground.height_m.min() == 0.0 and abs(ground.height_m.max() - levels[1]) < 1e-6


def test_noise_is_leveled() -> None:
    ground = performer_ground(raised(0.5, 0.51))
    assert len(set(levels_m(ground))) == 1


def test_a_slope_is_not_leveled() -> None:
    ground = performer_ground(raised(*np.arange(1.0, 1.12, 0.02)))
    assert np.ptp(levels_m(ground)) > 0.08


def test_without_rests_the_lowest_feet_tell() -> None:
    body, posture = stepping()
    sliding = posture.translation + np.linspace([0.0, 0.0, 0.3], [9.0, 0.0, 0.3], posture.batch[0])
    source = performance(body, Posture(posture.skeleton, sliding, posture.rotations, posture.angles))
    ground = performer_ground(source)
    assert ground.rests == ()
    assert abs(ground.height_m[0, 0] - 0.3) < 0.02


def test_the_ground_under_a_foot_changes_just_before_it_steps_up_and_after_it_steps_down() -> None:
    rests = tuple(Contact(0, first, first + 10, np.zeros(3)) for first in (0, 30, 60))
    time_s = np.arange(71) / 30.0
    height_m = _under(0, rests, np.array([0.0, 0.2, -0.1]), time_s)
    change, whole = int(np.ceil(30.0 * CHANGE_S)), int(30.0 * CHANGE_S)
    np.testing.assert_allclose(height_m[: 30 - change + 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(height_m[30:41], 0.2)
    np.testing.assert_allclose(height_m[40 + change :], -0.1)
    assert (np.diff(height_m[30 - whole : 31]) > 0.0).all()
    assert (np.diff(height_m[40 : 41 + whole]) < 0.0).all()
    np.testing.assert_array_equal(_under(1, rests, np.array([0.0, 0.2, -0.1]), time_s), height_m)


def test_the_ground_goes_evenly_between_rests_that_differ_by_noise_and_on_to_the_other_foots() -> None:
    rests = [Contact(point, first, first + 10, np.zeros(3)) for point, first in ((0, 0), (0, 30), (1, 50))]
    left, right = (_under(point, rests, np.array([0.0, 0.02, 0.5]), np.arange(71) / 30.0) for point in (0, 1))
    np.testing.assert_allclose(left[[5, 20, 35, 60]], [0.0, 0.01, 0.02, 0.5])
    np.testing.assert_allclose(right, left)
