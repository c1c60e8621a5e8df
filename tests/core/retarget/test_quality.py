"""Figures of a retargeted motion: each sees what it is there to see."""

import numpy as np
from _characters import plain_character, plain_map
from _performances import joints, quality, soles, solved, source_joints, steps
from keymark.core.retarget.character_motion import FootRest
from keymark.core.retarget.quality import (
    Quality,
    direction_errors_deg,
    farthest_mm,
    hand_distances_mm,
    measured,
    penetration_mm,
    skate_mm,
)


def test_directions_are_measured_to_a_ten_thousandth_of_a_degree() -> None:
    angle = np.radians([0.01, 90.0])
    source = {"a": np.zeros((2, 3)), "b": np.tile([1.0, 0.0, 0.0], (2, 1))}
    shown = {"a": np.ones((2, 3)), "b": 1.0 + 3.0 * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], 1)}
    errors = direction_errors_deg(source, shown, [("a", "b"), ("a", "c")])
    np.testing.assert_allclose(errors, [[0.01], [90.0]], atol=1e-6)
    assert direction_errors_deg(source, shown, [("c", "d")]).size == 0


def test_skate_counts_in_rests_alone() -> None:
    path = np.zeros((10, 3))
    path[:, 0] = 0.002 * np.arange(10)
    path[0] = 1.0
    rests = [FootRest("leg.L", 2, 6), FootRest("leg.R", 0, 9)]
    np.testing.assert_allclose(skate_mm({"leg.L": path}, rests), [2.0] * 4)
    assert skate_mm({}, rests).size == 0


def test_penetration_is_under_each_foots_own_ground() -> None:
    heights = {"foot.L": np.array([[0.3, 0.095]]), "toe.R": np.array([[0.0]])}
    ground = {"leg.L": np.array([0.1]), "leg.R": np.array([0.0])}
    found = penetration_mm(heights, ground)
    assert found is not None and abs(found - 5.0) < 1e-9
    assert penetration_mm({}, ground) is None


def test_hands_and_limbs_are_compared_where_both_are() -> None:
    path = np.zeros((3, 3))
    moved = path + [0.0, 0.003, 0.0]
    counted = np.array([True, False, True])
    np.testing.assert_allclose(
        hand_distances_mm({"L": path}, {"L": moved, "R": moved}, {"L": counted, "R": counted}), [3.0, 3.0]
    )
    assert abs((farthest_mm({"foot.L": path}, {"foot.L": moved}, ["foot.L", "foot.R"]) or 0.0) - 3.0) < 1e-9
    assert farthest_mm({}, {}, ["foot.L"]) is None


def test_a_spoiled_motion_has_worse_figures() -> None:
    character = plain_character()
    character_map = plain_map(character)
    motion = solved(character, character_map, steps())
    good = quality(character, character_map, steps(), motion)
    wobble = 0.01 * np.sin(np.arange(118))[:, None] * [1.0, 0.0, 0.0] - [0.0, 0.0, 0.01]
    shown = {role: path + wobble for role, path in joints(character_map, motion).items()}
    shown["shin.L"] = shown["shin.L"] + [0.0, 0.05, 0.0]
    sunk = {
        role: points + wobble[:, None] for role, points in soles(character, character_map, motion).items()
    }
    bad = measured(source_joints(steps()), motion, shown, sunk)
    assert good.skate_mm is not None and bad.skate_mm is not None and bad.skate_mm > 4.0 > good.skate_mm
    assert good.penetration_mm is not None and bad.penetration_mm is not None
    assert 9.9 < bad.penetration_mm < 10.2 and good.penetration_mm < 0.1
    assert good.legs_deg is not None and bad.legs_deg is not None and bad.legs_deg > good.legs_deg + 1.0


def test_figures_that_are_not_there_are_left_out() -> None:
    assert Quality(skate_mm=0.123456, keys=12).to_dict() == {"skate_mm": 0.123, "keys": 12}
