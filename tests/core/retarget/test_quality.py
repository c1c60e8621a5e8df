"""Figures of a retargeted motion: each sees what it is there to see."""

from dataclasses import replace

import numpy as np
import pytest
from _characters import plain_character, plain_map
from _performances import joints, quality, soles, solved, source_joints, steps
from keymark.core.feet.contacts import Contact
from keymark.core.feet.ground import floor_notes
from keymark.core.retarget.character_motion import HandGoal
from keymark.core.retarget.quality import (
    Quality,
    depths_m,
    direction_errors_deg,
    farthest_mm,
    measured,
    skate_mm,
    warnings_of,
)


def test_directions_are_measured_to_a_ten_thousandth_of_a_degree() -> None:
    angle = np.radians([0.01, 90.0])
    source = {"a": np.zeros((2, 3)), "b": np.tile([1.0, 0.0, 0.0], (2, 1))}
    shown = {"a": np.ones((2, 3)), "b": 1.0 + 3.0 * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], 1)}
    errors = direction_errors_deg(source, shown, [("a", "b"), ("a", "c")])
    np.testing.assert_allclose(errors, [[0.01], [90.0]], atol=1e-6)
    assert direction_errors_deg(source, shown, [("c", "d")]).size == 0


def test_skate_counts_in_rests_alone_the_heel_that_turns_and_no_toe_in_the_air() -> None:
    path = np.zeros((10, 1, 3))
    path[:, 0, 0] = 0.002 * np.arange(10)
    path[0] = 1.0
    rests = [Contact(0, 2, 6, np.zeros(3)), Contact(1, 0, 9, np.zeros(3))]
    np.testing.assert_allclose(skate_mm({"leg.L": path}, rests, 0.01), [2.0] * 4)
    assert skate_mm({}, rests, 0.01).size == 0
    still = np.tile([[0.0, 0.0, 0.08], [0.0, 0.05, 0.0], [0.0, -0.15, 0.005], [0.0, -0.15, 0.03]], (5, 1, 1))
    for point, expected in ((1, 3.0), (3, 0.0)):
        moved = still.copy()
        moved[:, point, 0] = 0.003 * np.arange(5)
        found = skate_mm({"leg.L": moved}, [Contact(0, 0, 4, np.zeros(3))], 0.01)
        np.testing.assert_allclose(found, [expected] * 4)


def test_depth_is_under_each_foots_own_ground() -> None:
    heights = {"foot.L": np.array([[0.3, 0.095]]), "toe.L": np.array([[0.12]]), "toe.R": np.array([[0.02]])}
    found = depths_m(heights, {"leg.L": np.array([0.1]), "leg.R": np.array([0.0])})
    np.testing.assert_allclose(found["leg.L"], 0.005)
    np.testing.assert_allclose(found["leg.R"], -0.02)
    assert depths_m({}, {"leg.L": np.array([0.1])}) == {}


def test_a_foot_in_the_floor_is_named_with_its_frames_and_depth() -> None:
    depth = np.zeros(118)
    depth[[3, 4, 5, 9]] = 0.004, 0.0123, 0.003, 0.0025
    frames = 11.0 + np.arange(118)
    note = "The left foot of 'Anna' is up to 12.3 mm below the floor, in frames 14 to 16, 20"
    assert floor_notes({"L": depth, "R": -depth}, frames, " of 'Anna'") == (note,)
    assert floor_notes({"L": 0.1 * depth}, frames) == ()
    assert floor_notes({"L": 0.1 * depth}, frames, size=0.1) != ()


def test_hands_and_limbs_are_compared_where_both_are() -> None:
    path = np.zeros((3, 3))
    moved = path + [0.0, 0.003, 0.0]
    assert abs((farthest_mm({"foot.L": path}, {"foot.L": moved}, ["foot.L", "foot.R"]) or 0.0) - 3.0) < 1e-9
    assert farthest_mm({}, {}, ["foot.L"]) is None
    motion = solved(plain_character(), plain_map(plain_character()), steps())
    counts, place = np.arange(118) >= 60, np.tile([0.3, 0.0, 1.0], (118, 1))
    goal = HandGoal(place, counts * 1.0, (np.arange(118) >= 90) * 1.0, np.arange(118) < 100)
    motion = replace(motion, hands={"L": goal, "R": goal})
    up = motion.to_world.rotation @ motion.stance.T
    off = np.where(counts[:, None], [0.0, 0.003, 0.004], 1.0)
    shown = {"hand.L": (place + off) @ up.T + motion.to_world.location}
    found = measured(source_joints(steps()), motion, shown, {}).quality
    np.testing.assert_allclose([found.hands_mm, found.hands_worst_mm, found.hands_floor_mm], [5.0, 5.0, 4.0])


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
    bad = measured(source_joints(steps()), motion, shown, sunk).quality
    assert good.skate_mm is not None and bad.skate_mm is not None and bad.skate_mm > 4.0 > good.skate_mm
    assert good.penetration_mm is not None and bad.penetration_mm is not None
    assert 9.9 < bad.penetration_mm < 10.2 and good.penetration_mm < 0.1
    assert good.legs_deg is not None and bad.legs_deg is not None and bad.legs_deg > good.legs_deg + 1.0
    raised = {role: points + [0.0, 0.0, 0.05] for role, points in sunk.items()}
    lifted = measured(source_joints(steps()), motion, shown, raised).quality.lifted_mm
    assert good.lifted_mm is not None and good.lifted_mm < 1.0 and lifted == pytest.approx(40.0, abs=0.5)


def test_figures_out_of_bounds_are_warned_of_at_the_characters_size() -> None:
    assert Quality(skate_mm=0.123456, keys=12).to_dict() == {"skate_mm": 0.123, "keys": 12}
    good = {"arms_deg": 9.0, "legs_deg": None, "skate_mm": 14.0, "penetration_mm": 19.0, "keys": 1000}
    assert warnings_of(good, 1.0) == ()
    assert warnings_of({**good, "skate_mm": 16.0}, 2.0) == () != warnings_of({**good, "skate_mm": 16.0}, 1.0)
    (words,) = warnings_of({**good, "legs_deg": 38.6, "lifted_mm": 1002.0}, 1.0)
    assert "legs are 39 degrees from the performer's, resting feet are 1002 mm above the floor;" in words
