"""Which controls are keyed, in which order their keys are found, and how far points may stray."""

from dataclasses import replace

import numpy as np
import pytest
from _characters import plain_character, plain_map
from _controls import with_ik
from _recorded import assert_recorded
from keymark.core.feet.contacts import Contact
from keymark.core.keys.tolerances import RESTING_M
from keymark.core.retarget.character import Similarity
from keymark.core.retarget.character_motion import CharacterMotion
from keymark.core.retarget.controls.control_channels import (
    NOTHING,
    Control,
    ControlKind,
    ControlSpace,
    PlannedControl,
    limb_keys,
    planned_controls,
)
from keymark.core.retarget.controls.control_motion import PoleSetting, pole_offset, pole_poses
from keymark.core.retarget.controls.point_tolerances import (
    SWITCH_M,
    HeldPoint,
    PointKind,
    ToleranceRules,
    held_points,
)
from keymark.core.retarget.controls.reduction import FollowingControls, control_stages
from keymark.core.retarget.maps.character_map import CharacterMap
from keymark.core.take.conversion_settings import LimbKeys, RetargetOptions, RootMotion

FRAMES = 30


@pytest.fixture
def known() -> CharacterMap:
    """A plain character's map with goals and poles."""
    return with_ik(plain_map(plain_character()))


def names(known: CharacterMap, **options: object) -> set[str]:
    """Names of the controls that are keyed."""
    return {plan.name for plan in planned_controls(known, RetargetOptions(**options))}  # type: ignore[arg-type]


def test_limbs_are_keyed_as_chosen(known: CharacterMap) -> None:
    both = names(known, arms=LimbKeys.BOTH, legs=LimbKeys.BOTH)
    assert {"hips", "chest", "thigh.L", "foot.R", "toe.L", "ik_foot.L", "pole_arm.R"} <= both
    fk = names(known, arms=LimbKeys.FK, legs=LimbKeys.FK)
    assert not any(name.startswith(("ik_", "pole_")) for name in fk)
    ik = names(known)
    assert not {"upper_arm.L", "forearm.L", "hand.L", "thigh.L", "shin.L", "foot.L"} & ik
    assert {"shoulder.L", "toe.L", "ik_hand.L"} <= ik
    rooted = replace(known, root="root")
    assert "root" not in names(rooted)
    assert "root" in names(rooted, root_motion=RootMotion.ROOT_BONE)


def test_roles_that_are_left_alone_are_not_keyed(known: CharacterMap) -> None:
    left = replace(known, left_alone=("hand.L", "neck"))
    assert not {"hand.L", "neck", "ik_hand.L", "pole_arm.L"} & names(left)
    assert {"forearm.L", "ik_hand.R"} <= names(left)
    assert limb_keys(left, RetargetOptions(), "arm.L") is LimbKeys.FK


def test_a_limb_without_fk_controls_is_keyed_in_ik(known: CharacterMap) -> None:
    bare = replace(known, fk={"thigh.L": (None,), "shin.L": (None,), "foot.L": ("ik_foot.L",)})
    assert limb_keys(bare, RetargetOptions(legs=LimbKeys.FK), "leg.L") is LimbKeys.IK
    assert limb_keys(bare, RetargetOptions(legs=LimbKeys.FK), "leg.R") is LimbKeys.FK


def control(name: str, kind: ControlKind, turner: int, carrier: int) -> Control:
    """A control of a limb."""
    space = ControlSpace(turner, np.eye(3), carrier, np.zeros(3), np.eye(3), 0.0, 0.0)
    return Control(PlannedControl(name, kind, name, "leg.L"), "XYZ", space, turns=True)


def test_legs_follow_the_body_and_goals_follow_the_legs() -> None:
    fk, goal = ControlKind.FK, ControlKind.GOAL
    controls = [
        control("hips", ControlKind.HIPS, NOTHING, NOTHING),
        control("thigh", fk, 0, 0),
        control("shin", fk, 1, 1),
        control("goal", goal, NOTHING, NOTHING),
        control("toe", ControlKind.TOE, 3, 3),
        control("pole", ControlKind.POLE, 0, 0),
        control("odd", goal, NOTHING, 0),
        control("chest", fk, 0, 0),
    ]
    body, following = control_stages(controls, {"leg.L": (0, [1, 2])})
    assert body == (0, 6, 7)
    assert following == (
        FollowingControls((1, 2), 0, "leg.L"),
        FollowingControls((3, 4), NOTHING),
        FollowingControls((5,), 0),
    )
    on_leg = [*controls[:3], control("knife", fk, 2, 2)]
    assert control_stages(on_leg, {"leg.L": (0, [1, 2])})[0] == (0, 1, 2, 3)


def still_motion(rests: tuple[Contact, ...]) -> CharacterMotion:
    """Nothing but rests."""
    return CharacterMotion({}, {}, None, Similarity(np.eye(3), np.zeros(3), 1.0), rests, {}, 1.0)


def test_resting_and_low_feet_are_held_more_tightly() -> None:
    motion = still_motion((Contact(0, 5, 9, np.zeros(3)),))
    rules = ToleranceRules(motion, np.arange(FRAMES) / 30.0, np.array([0.0, 0.0, 1.0]), 0.005)
    path = np.zeros((FRAMES, 3))
    path[20:, 2] = 0.2
    ankle = HeldPoint("foot.L", np.zeros(3), PointKind.END, "leg.L")
    allowed = rules.of(ankle, path, True, SWITCH_M)
    assert set(allowed[5:10]) == {RESTING_M}
    assert set(np.delete(allowed, range(5, 10))) == {SWITCH_M}
    hidden = rules.of(ankle, path, False, 0.005)
    assert set(hidden[5:10]) == {SWITCH_M} and hidden[0] == 0.005
    sole = replace(ankle, kind=PointKind.SOLE)
    low = rules.of(sole, path, False, 0.005)
    assert (low[:20] < 0.002).all() and (low[20:] == 0.005).all()
    assert (rules.of(replace(ankle, kind=PointKind.BODY), path, True, 0.001) == 0.005).all()


def test_straight_limbs_are_held_by_what_their_knees_do() -> None:
    rules = ToleranceRules(still_motion(()), np.arange(2) / 30.0, np.array([0.0, 0.0, 1.0]), 0.005)
    root, end = np.zeros((2, 3)), np.array([[0.0, 0.0, -0.8], [0.0, 0.0, -0.6]])
    middle = np.array([[0.0, -0.01, -0.4], [0.0, -0.26, -0.3]])
    reach = rules.reach_m((root, middle, end))
    assert reach[0] < 0.0003 < reach[1] <= 0.005
    pole = rules.pole_m((root, middle, end), 0.5)
    assert pole[0] == pytest.approx(0.04 * 0.51)
    assert pole[1] == pytest.approx(0.005 * 0.76 / 0.26)


def test_tolerances_are_in_proportion_to_the_character() -> None:
    rests, time_s, up = (Contact(0, 5, 9, np.zeros(3)),), np.arange(FRAMES) / 30.0, np.array([0.0, 0.0, 1.0])
    path = np.linspace(0.0, 0.3, FRAMES)[:, None] * up
    limb = (
        np.zeros((2, 3)),
        np.array([[0.0, -0.01, -0.4], [0.0, -0.26, -0.3]]),
        np.array([[0.0, 0.0, -0.8]] * 2),
    )
    usual = ToleranceRules(still_motion(rests), time_s, up, 0.005)
    tiny = ToleranceRules(replace(still_motion(rests), size=0.01), time_s, up, 0.005)
    for kind in PointKind:
        point = HeldPoint("foot.L", np.zeros(3), kind, "leg.L")
        for shown in (True, False):
            allowed = usual.of(point, path, shown, SWITCH_M)
            np.testing.assert_allclose(tiny.of(point, 0.01 * path, shown, SWITCH_M), 0.01 * allowed)
    small = tuple(0.01 * joint for joint in limb)
    np.testing.assert_allclose(tiny.reach_m(small), 0.01 * usual.reach_m(limb))
    np.testing.assert_allclose(tiny.pole_m(small, 0.005), 0.01 * usual.pole_m(limb, 0.5))


@pytest.mark.parametrize("offset_rad", [0.0, 0.7, np.pi])
def test_poles_lie_where_their_joints_point(offset_rad: float) -> None:
    rng = np.random.default_rng(5)
    root, middle, end = rng.normal(size=(3, 4, 3))
    axis = (end - root) / np.linalg.norm(end - root, axis=-1, keepdims=True)
    out = middle - root - ((middle - root) * axis).sum(axis=-1, keepdims=True) * axis
    bend = out / np.linalg.norm(out, axis=-1, keepdims=True)
    places = pole_poses((root, middle, end), bend, PoleSetting(0.5, offset_rad))[:, :3, 3]
    for frame in range(4):
        found = pole_offset(root[frame], middle[frame], end[frame], places[frame])
        assert np.cos(found - offset_rad) == pytest.approx(1.0)
        apart = places[frame] - root[frame]
        away = np.linalg.norm(apart - (apart @ axis[frame]) * axis[frame])
        assert away == pytest.approx(np.linalg.norm(out[frame]) + 0.5)


def test_every_bone_has_points_that_show_its_place_and_turn() -> None:
    character = plain_character(scale=0.01, roll_rad=0.4)
    known = plain_map(character)
    soles = {"foot.L": np.array([[10.0, 5.0, 0.0]])}
    points = held_points(character, known, soles)
    assert_recorded("held points", *(point.place for point in points))
    for role in known.roles:
        for bone in known.bones(role):
            places = np.array([point.place for point in points if point.bone == bone])
            spread = np.linalg.svd(places - places.mean(axis=0), compute_uv=False)
            assert spread[1] > 1.0  # a centimeter
    sole = next(point for point in points if point.kind is PointKind.SOLE)
    rest = character.bone("foot.L").rest
    assert rest[:3, :3] @ sole.place + rest[:3, 3] == pytest.approx([10.0, 5.0, 0.0])
