"""Hands that are brought to where they belong: the hips, each other, the floor."""

import numpy as np
import pytest
from _characters import plain_character, plain_map
from _performances import joints, performance, shaped, solved, source_joints, steps, with_hands
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body, SegmentMotion
from keymark.core.body.posture import Posture
from keymark.core.body.posture_fit import fit_posture
from keymark.core.retarget.character_motion import CharacterMotion
from keymark.core.take.conversion_settings import RetargetOptions

ON_HIPS = (np.array([0.2, -0.02, 1.03]), np.array([-0.2, -0.02, 1.03]))
TOGETHER = (np.array([0.05, -0.32, 1.25]), np.array([-0.05, -0.32, 1.25]))


def broader(name: str, place: Array) -> Array:
    """Hips 8 cm wider on either side, shoulders 6 cm narrower."""
    leg = name.startswith(("thigh", "shin", "foot", "toe"))
    arm = name.startswith(("upper_arm", "forearm", "hand", "finger"))
    return place + [np.sign(place[0]) * (0.08 * leg - 0.06 * arm), 0.0, 0.0]


def apart(paths: dict[str, Array]) -> Array:
    """(F,) distance of the wrists [m]."""
    return np.asarray(np.linalg.norm(paths["hand.L"] - paths["hand.R"], axis=-1))


def test_hands_that_meet_meet_on_another_body() -> None:
    character, character_map = shaped(broader)
    source = with_hands(*TOGETHER)
    shown = joints(character_map, solved(character, character_map, source))
    alone = joints(
        character_map, solved(character, character_map, source, RetargetOptions(reach_hands=False))
    )
    wanted = apart(source_joints(source))[-1] * arm_ratio(shown, source)
    assert abs(apart(shown)[-1] - wanted) < 0.005
    assert abs(apart(alone)[-1] - wanted) > 0.015


def arm_ratio(shown: dict[str, Array], source: SegmentMotion) -> float:
    """Length of the character's arms over the performer's."""
    given = source_joints(source)

    def arm(paths: dict[str, Array]) -> float:
        upper = np.linalg.norm(paths["forearm.L"] - paths["upper_arm.L"], axis=-1)
        return float((upper + np.linalg.norm(paths["hand.L"] - paths["forearm.L"], axis=-1))[0])

    return arm(shown) / arm(given)


def test_hands_on_the_hips_go_out_with_them() -> None:
    source = with_hands(*ON_HIPS)
    plain = plain_character()
    slim = joints(plain_map(plain), solved(plain, plain_map(plain), source))
    character, character_map = shaped(broader)
    wide = joints(character_map, solved(character, character_map, source))
    assert apart(wide)[-1] > 1.5 * apart(slim)[-1]
    middle = 0.5 * (wide["thigh.L"] + wide["thigh.R"])
    height = (wide["hand.L"] - middle)[-1, 2]
    assert 0.05 < height < 0.15


def test_arms_that_touch_nothing_keep_their_directions() -> None:
    character = plain_character()
    character_map = plain_map(character)
    reaching = solved(character, character_map, steps())
    free = solved(character, character_map, steps(), RetargetOptions(reach_hands=False))
    away = np.maximum(reaching.hands["L"].share, reaching.hands["R"].share) < 1e-9
    assert away.sum() > 30
    for name in ("upper_arm.L", "forearm.R"):
        np.testing.assert_allclose(reaching.poses[name][away], free.poses[name][away], atol=1e-9)


@pytest.mark.parametrize("reach_m", [0.6, 0.75, 0.9])
def test_goals_out_of_reach_straighten_the_arm_smoothly(reach_m: float) -> None:
    source = with_hands(np.array([0.06, -reach_m, 1.3]), np.array([-0.06, -reach_m, 1.3]))
    character, character_map = shaped(broader)
    motion = solved(character, character_map, source)
    steps_m = _steps(motion, "forearm.L")
    assert steps_m.max() < 0.065
    assert np.abs(np.diff(steps_m)).max() < 0.042


def _steps(motion: CharacterMotion, name: str) -> Array:
    return np.asarray(np.linalg.norm(np.diff(motion.poses[name][:, :3, 3], axis=0), axis=-1))


def test_hands_stay_out_of_the_floor() -> None:
    source = _squatting()
    character = plain_character()
    character_map = plain_map(character)
    motion = solved(character, character_map, source)
    shown = joints(character_map, motion)
    low = source_joints(source)["hand.L"][:, 2]
    at_floor = low < 0.1
    assert at_floor.sum() > 5
    np.testing.assert_allclose(shown["hand.L"][at_floor, 2], motion.size * low[at_floor], atol=0.02)
    tip = character.bone("hand.L")
    along = tip.rest[:3, :3].T @ (tip.tail - tip.head)
    fingers = shown["hand.L"] + motion.poses["hand.L"][:, :3, :3] @ along
    assert fingers[:, 2].min() > -0.002


def _squatting() -> SegmentMotion:
    """A performer who squats down until the hands reach the floor, and stays."""
    body = Body(Actor.from_stature(1.75))
    frames, names, points = 60, body.skeleton.dof_names, body.skeleton.point_names
    share = np.clip(np.linspace(-0.2, 1.4, frames), 0.0, 1.0)
    share = share * share * (3.0 - 2.0 * share)
    vector = np.zeros((frames, len(names)))
    for side, out in (("L", 1.0), ("R", -1.0)):
        vector[:, names.index(f"knee.{side}.flexion")] = 2.4 * share
        vector[:, names.index(f"hip.{side}.rotation_x")] = -2.2 * share
        vector[:, names.index(f"shoulder.{side}.rotation_y")] = 1.2 * out
        vector[:, names.index(f"elbow.{side}.flexion")] = 0.3
    vector[:, names.index("pelvis.rotation_x")] = 1.1 * share
    vector[:, names.index("waist.rotation_x")] = 1.6 * share
    posture = Posture.from_vector(body.skeleton, vector)
    ankles = body.points(body.pose(posture))[:, [points.index(f"ankle.{side}") for side in "LR"]]
    vector[:, :3] = [0.0, 0.0, 0.07] - ankles.mean(axis=1)
    start = Posture.from_vector(body.skeleton, vector)
    wanted = body.points(body.pose(start))
    for side, out in (("L", 0.2), ("R", -0.2)):
        wanted[:, points.index(f"elbow.{side}")] = np.nan
        wrist = wanted[:, points.index(f"wrist.{side}")]
        wrist += share[:, None] * (np.array([out, -0.5, 0.08]) - wrist)
    return performance(body, fit_posture(body, wanted, start).posture)
