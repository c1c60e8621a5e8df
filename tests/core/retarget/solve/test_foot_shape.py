"""The shape of feet: from the bones, from the map, and the ground under a resting character."""

from dataclasses import replace

import numpy as np
import pytest
from _characters import plain_character, plain_map
from _performances import shaped, solved, steps
from keymark.core.retarget.solve.feet import HEEL_BEHIND, foot_shape, rest_floor_m, sole_points
from keymark.core.retarget.solve.rest_body import RestBody


@pytest.mark.parametrize("height", [0.0, -0.82, 3.0])
def test_a_character_stands_on_its_origin_or_off_it_under_its_toes(height: float) -> None:
    character, character_map = shaped(lambda _, place: place + [0.0, 0.0, height])
    floor_m = rest_floor_m(RestBody.of(character, character_map))
    assert height - 0.02 < floor_m < height + 0.015 and (floor_m == 0.0) == (height == 0.0)


@pytest.mark.parametrize("without", [(), ("toe",)])
def test_a_foot_of_bones_lies_flat_from_heel_to_tip(without: tuple[str, ...]) -> None:
    character = plain_character(without=without, scale=0.01)
    body = RestBody.of(character, plain_map(character))
    shape = foot_shape(body, "L", 0.0)
    points = (
        shape.foot if shape.toe_joint is None else np.concatenate([shape.foot, shape.toe + shape.toe_joint])
    )
    np.testing.assert_allclose(points[:, 2], -0.08, atol=1e-9)
    assert abs(shape.ankle_m - 0.08) < 1e-9
    assert points[:, 1].max() > 0.04 and points[:, 1].min() < -0.1
    assert points[:, 0].max() > 0.02 and points[:, 0].min() < -0.02
    assert (shape.toe_joint is None) == bool(without)
    given = sole_points(body, {"L": shape})
    np.testing.assert_allclose(given["foot.L"][:, 2], 0.0, atol=1e-9)
    assert np.abs(given["foot.L"]).max() > 10.0


def test_the_maps_soles_are_the_soles() -> None:
    character = plain_character()
    sole = ((0.1, 0.09, -0.03), (0.07, -0.1, -0.03), (0.14, -0.1, -0.03))
    tip = ((0.1, -0.2, -0.03),)
    soles = {f"{part}.{side}": points for side in "LR" for part, points in (("foot", sole), ("toe", tip))}
    body = RestBody.of(character, replace(plain_map(character), soles=soles))
    floor_m = rest_floor_m(body)
    assert floor_m == -0.03
    shape = foot_shape(body, "L", floor_m)
    np.testing.assert_allclose(sole_points(body, {"L": shape})["foot.L"], sole, atol=1e-12)
    np.testing.assert_allclose(sole_points(body, {"L": shape})["toe.L"], tip, atol=1e-12)
    assert abs(shape.ankle_m - 0.11) < 1e-9
    assert abs(shape.heel[1] - 0.07) < 0.02
    assert abs(shape.front[1] + 0.13) < 0.01


def test_tails_are_believed_where_they_meet_heads() -> None:
    character, character_map = shaped(lambda _, place: place)
    astray = replace(
        character, bones=tuple(replace(b, tail=b.head + [28.0, 0.0, 0.0]) for b in character.bones)
    )
    meant, anywhere = RestBody.of(character, character_map), RestBody.of(astray, character_map)
    assert character.tails_are_meant and not astray.tails_are_meant
    size_m = np.ptp([bone.head for bone in character.bones], axis=0).max()
    for share, near in ((0.005, True), (0.007, False)):
        beside = [replace(bone, tail=bone.tail + [share * size_m, 0.0, 0.0]) for bone in character.bones]
        assert replace(character, bones=tuple(beside)).tails_are_meant == near
    assert anywhere.tip("toe.L") is None
    tips = [foot_shape(body, "L", 0.0).toe[:, 1].min() for body in (meant, anywhere)]
    np.testing.assert_allclose(tips, [-0.08, -0.052], atol=0.01)


@pytest.mark.parametrize("points", [((0.1, -0.05, 0.0),), ((0.1, 0.09, 0.0),)], ids=["no heel", "no ball"])
def test_a_sole_on_one_side_of_the_ankle_is_enough(points: tuple[tuple[float, float, float], ...]) -> None:
    character = plain_character()
    soles = {f"foot.{side}": points for side in "LR"}
    motion = solved(character, replace(plain_map(character), soles=soles), steps())
    assert all(np.isfinite(pose).all() for pose in motion.poses.values())


def test_toes_that_are_left_alone_are_part_of_the_foot() -> None:
    character = plain_character()
    known = plain_map(character)
    stiff = replace(known, left_alone=("toe.L", "toe.R"))
    shape = foot_shape(RestBody.of(character, stiff), "L", 0.0)
    assert shape.toe_joint is None and not len(shape.toe)
    moving = foot_shape(RestBody.of(character, known), "L", 0.0)
    assert moving.toe_joint is not None
    reach = (moving.toe_joint + moving.toe)[:, 1].min()
    assert abs(shape.foot[:, 1].min() - reach) < 0.03
    assert abs(shape.ankle_m - moving.ankle_m) < 1e-9


def test_a_sole_of_bones_has_the_proportions_of_a_foot() -> None:
    character = plain_character(without=("toe",))
    body = RestBody.of(character, plain_map(character))
    inner, outer, near, far = foot_shape(body, "L", 0.0).foot[:4]
    heel, ball = 0.5 * (inner + outer), 0.5 * (near + far)
    width = float(np.linalg.norm(far - near))
    assert np.linalg.norm(outer - inner) == pytest.approx(0.7 * width)
    length = width / 0.4  # from ankle to tip
    assert np.linalg.norm(ball[:2]) == pytest.approx(0.6 * length)
    assert np.linalg.norm(heel[:2]) == pytest.approx(HEEL_BEHIND * length)
    assert (far - near) @ (ball - heel) == pytest.approx(0.0, abs=1e-9)
