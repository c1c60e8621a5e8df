"""Planted feet: what rests stands still, what moves goes on moving, and nothing jumps."""

import numpy as np
import pytest
from _scene import BODY
from keymark.core.body.posture import Posture
from keymark.core.feet.contacts import Contact, find_contacts
from keymark.core.feet.fading import FADE_S
from keymark.core.feet.planted_feet import plant_feet
from keymark.core.keys.rig import NO_TURN, Rig, RigBone
from keymark.core.keys.tolerances import FLOOR_M, foot_rows, point_tolerances
from keymark.core.progress import run

FPS = 30.0
NAMES = BODY.skeleton.point_names
ANKLES = [NAMES.index("ankle.L"), NAMES.index("ankle.R")]


def places(posture: Posture) -> np.ndarray:
    """(F, 13, 3) principal points."""
    return BODY.points(BODY.pose(posture))


def skate_mm(posture: Posture, contacts: tuple[Contact, ...]) -> float:
    """Mean horizontal travel per frame of resting ankles."""
    ankles = places(posture)[:, ANKLES]
    travel = [
        np.linalg.norm(np.diff(ankles[c.first : c.last + 1, c.point, :2], axis=0), axis=-1) for c in contacts
    ]
    return 1e3 * float(np.concatenate(travel).mean())


def step_and_stand() -> Posture:
    """Sixty frames: the left foot is lifted in the middle, all wander a little, as estimates do."""
    names = BODY.skeleton.dof_names
    vector = np.zeros((60, len(names)))
    vector[:, 2] = 0.9
    time = np.arange(60) / FPS
    lift = np.clip(np.sin(np.pi * (time - 0.7) / 0.6), 0.0, None) * ((time > 0.7) & (time < 1.3))
    for side, amount in (("L", lift), ("R", np.zeros(60))):
        vector[:, names.index(f"hip.{side}.rotation_x")] = -0.35 - 0.6 * amount
        vector[:, names.index(f"knee.{side}.flexion")] = 0.7 + 0.8 * amount
    vector[:, 0] = 0.008 * np.sin(2.0 * time)
    vector[:, 1] = 0.006 * np.cos(3.0 * time)
    return Posture.from_vector(BODY.skeleton, vector)


TIME_S = np.arange(60) / FPS


def test_resting_feet_stand_still_afterwards() -> None:
    before = step_and_stand()
    planted = run(plant_feet(BODY, before, TIME_S))
    after = places(planted.posture)
    assert [contact.point for contact in planted.contacts] == [0, 0, 1]
    for contact in planted.contacts:
        rest = after[contact.first : contact.last + 1, ANKLES[contact.point]]
        assert np.linalg.norm(rest - contact.place, axis=-1).max() < 1e-3
    assert skate_mm(before, planted.contacts) > 10.0 * skate_mm(planted.posture, planted.contacts)


def test_frames_far_from_a_rest_keep_their_numbers() -> None:
    leave = np.zeros((60, BODY.skeleton.dof_count))
    leave[:, 0] = 0.03 * np.clip(np.arange(60) - 20, 0, None)
    walking = step_and_stand().plus(leave)
    planted = run(plant_feet(BODY, walking, TIME_S))
    assert planted.contacts
    last = max(contact.last for contact in planted.contacts)
    free = np.arange(60) > last + FADE_S * FPS + 1
    assert free.sum() > 20
    assert np.array_equal(planted.posture.translation[free], walking.translation[free])
    assert np.array_equal(planted.posture.rotations[free], walking.rotations[free])


def test_the_other_foot_and_the_upper_body_stay() -> None:
    before = step_and_stand()
    planted = run(plant_feet(BODY, before, TIME_S))
    moved = np.linalg.norm(places(planted.posture) - places(before), axis=-1)
    lifted = slice(26, 34)
    assert moved[lifted, ANKLES[0]].max() < 2e-3
    assert moved[:, NAMES.index("head")].max() < 5e-3
    step = planted.posture.minus(before)
    arms = [i for i, name in enumerate(BODY.skeleton.dof_names) if name.startswith(("shoulder", "elbow"))]
    assert np.array_equal(step[:, arms], np.zeros((60, len(arms))))


def test_an_unsteady_foot_does_not_rest() -> None:
    slide = np.zeros((60, 2, 3))
    slide[:, :, 0] = 0.08 * TIME_S[:, None]
    assert find_contacts(slide, TIME_S) == ()
    assert len(find_contacts(slide, TIME_S, stray_m=0.1)) == 2


def test_a_foot_held_up_does_not_rest_on_air() -> None:
    path = np.zeros((60, 1, 3))
    path[:25, 0, 2] = 0.5
    path[25:31, 0, 2] = np.linspace(0.5, 0.0, 6)
    contacts = find_contacts(path, TIME_S)
    assert len(contacts) == 1
    assert contacts[0].first > 28


@pytest.mark.parametrize(("high_m", "rests"), [(0.2, [0, 1]), (0.4, [1])], ids=["on a stool", "in the air"])
def test_a_foot_held_still_high_over_the_other_does_not_rest(high_m: float, rests: list[int]) -> None:
    path = np.zeros((60, 2, 3))
    path[:, 0, 2] = high_m
    assert [contact.point for contact in find_contacts(path, TIME_S)] == rests


def test_a_motion_without_a_rest_is_returned_as_it_is() -> None:
    posture = step_and_stand()[np.arange(3)]
    planted = run(plant_feet(BODY, posture, TIME_S[:3]))
    assert planted.contacts == ()
    assert planted.posture is posture


def test_a_foot_on_its_way_between_two_rests_does_not_go_below_the_floor() -> None:
    names = BODY.skeleton.dof_names
    dip = np.clip(np.sin(np.pi * (TIME_S - 0.7) / 0.6), 0.0, None) * ((TIME_S > 0.7) & (TIME_S < 1.3))
    vector = np.zeros((60, len(names)))
    vector[:, 2] = 0.75  # on the scene's ground: under a higher one a foot may have stepped down
    for side, amount in (("L", dip), ("R", np.zeros(60))):
        vector[:, names.index(f"hip.{side}.rotation_x")] = -0.35 + 0.2 * amount
        vector[:, names.index(f"knee.{side}.flexion")] = 0.7 - 0.4 * amount
    vector[:, names.index("hip.L.rotation_y")] = -0.12 * np.clip((TIME_S - 0.7) / 0.6, 0.0, 1.0)
    before = Posture.from_vector(BODY.skeleton, vector)
    planted = run(plant_feet(BODY, before, TIME_S))
    assert [contact.point for contact in planted.contacts] == [0, 0, 1]
    floor = min(contact.place[2] for contact in planted.contacts)
    depth = [floor - places(posture)[:, ANKLES[0], 2] for posture in (before, planted.posture)]
    assert depth[0].max() > 0.03 > 0.001 > depth[1].max()
    assert np.abs(np.diff(depth[1], 2)).max() < 0.02  # it does not jump
    still = places(planted.posture)[:, ANKLES[1]]
    assert np.ptp(still[10:50], axis=0).max() < 2e-3


def test_soles_near_the_ground_are_held_by_few_keys() -> None:
    still, ends = np.eye(3), np.zeros((2, 3))
    rig = Rig(tuple(RigBone(f"foot.{side}", -1, NO_TURN, still, still, np.zeros(3), ends) for side in "LR"))
    near = np.zeros((60, 2), dtype=bool)
    near[20:30, 0] = True
    allowed = point_tolerances(rig, 60, 0.005, (), near)
    left, right = foot_rows(rig, "L")[1:], foot_rows(rig, "R")[1:]
    assert len(left) == 2 and set(allowed[20:30][:, left].ravel()) == {FLOOR_M}
    assert set(allowed[:, right].ravel()) == {0.005} and set(allowed[30:, left[0]]) == {0.005}


def test_the_change_at_a_rest_fades_frame_by_frame() -> None:
    before = step_and_stand()
    planted = run(plant_feet(BODY, before, TIME_S))
    change = np.linalg.norm((places(planted.posture) - places(before))[:, ANKLES], axis=-1)
    for contact in planted.contacts:
        for edge, way in ((contact.first, -1), (contact.last, 1)):
            if not 5 <= edge < len(change) - 5 or change[edge, contact.point] < 1e-3:
                continue
            fading = change[edge : edge + 5 * way : way, contact.point]
            assert (np.diff(fading) < 0.0).all() and fading[1] > 0.5 * fading[0]
