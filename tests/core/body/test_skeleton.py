"""The default skeleton, the actor's sizes, where the feet touch the floor, and the colors of both sides."""

import numpy as np
import pytest
from keymark.core.body.actor import REQUIRED, SHARES_OF_STATURE, Actor
from keymark.core.body.body_volume import sole_heights_m, sole_places, standing_posture
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError

BODY = Body(Actor.from_stature(1.75))
LIMB_POINTS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
POINTS = ("head", *(f"{name}.{side}" for name in LIMB_POINTS for side in "LR"))


def test_the_skeleton_has_the_papers_numbers() -> None:
    assert HUMAN.dof_count == 34
    assert len(set(HUMAN.dof_names)) == 34
    assert HUMAN.point_names == POINTS


def test_degrees_of_freedom_are_all_counted_once() -> None:
    indices = np.concatenate([np.arange(3), HUMAN.ball_dofs.ravel(), HUMAN.hinge_dofs])
    np.testing.assert_array_equal(np.sort(indices), np.arange(34))
    assert HUMAN.deviations.shape == (34,)
    assert (HUMAN.deviations > 0.0).all()
    assert (HUMAN.limits[:, 0] < HUMAN.limits[:, 1]).all()


def test_at_rest_the_performer_stands_in_a_t_facing_minus_y() -> None:
    pose = BODY.pose(Posture.rest(HUMAN))
    place = dict(zip(HUMAN.point_names, BODY.points(pose), strict=True))
    length = BODY.actor.segments_m
    np.testing.assert_allclose(np.stack(list(place.values()))[:, 1], 0.0, atol=1e-15)
    arm = 0.5 * length["shoulder_width"] + length["upper_arm.L"] + length["forearm.L"]
    np.testing.assert_allclose(place["wrist.L"], [arm, 0.0, length["trunk"]])
    np.testing.assert_allclose(
        place["ankle.R"], [-0.5 * length["hip_width"], 0.0, -length["thigh.R"] - length["shin.R"]]
    )
    np.testing.assert_allclose(place["head"], [0.0, 0.0, length["trunk"] + length["neck_head"]])
    start, end = BODY.segment_ends(pose, "foot.L")
    assert (end - start)[1] < -0.1


def mirrored(vector: np.ndarray) -> np.ndarray:
    """The posture vector of the mirror image: sides swapped; of turns, those about y and z change sign."""
    index = {name: i for i, name in enumerate(HUMAN.dof_names)}
    result = np.empty(34)
    for name, i in index.items():
        joint, part = name.rsplit(".", 1)
        other = joint[:-1] + {"L": "R", "R": "L"}[joint[-1]] if joint[-2] == "." else joint
        flips = part in ("location_x", "rotation_y", "rotation_z")
        result[index[f"{other}.{part}"]] = -vector[i] if flips else vector[i]
    return result


def test_limits_and_deviations_are_mirror_images() -> None:
    np.testing.assert_allclose(np.abs(mirrored(HUMAN.deviations)), HUMAN.deviations)
    lower, upper = mirrored(HUMAN.limits[:, 0]), mirrored(HUMAN.limits[:, 1])
    np.testing.assert_allclose(np.sort(np.stack([lower, upper], -1), axis=-1), HUMAN.limits)


def test_average_proportions_follow_the_stature() -> None:
    small, tall = Actor.from_stature(1.2), Actor.from_stature(1.8)
    for name, length in small.segments_m.items():
        assert tall.segments_m[name] == pytest.approx(1.5 * length)
    assert tall.stature_m == pytest.approx(1.8)


def test_hands_and_feet_follow_from_the_legs_where_not_given() -> None:
    lengths = {name: value for name, value in Actor.from_stature(1.6).segments_m.items() if name in REQUIRED}
    actor = Actor(lengths)
    assert actor.segments_m["foot.R"] == pytest.approx(0.110 * 1.6)
    assert Actor({**lengths, "hand.L": 0.15}).segments_m["hand.L"] == 0.15


def lengths_with(**changes: object) -> dict[str, object]:
    return {**Actor.from_stature(1.7).segments_m, **changes}


@pytest.mark.parametrize(
    ("lengths", "sentence"),
    [
        ({}, r"actor\.segments_m: upper_arm\.L is missing"),
        (lengths_with(trunk="long"), "trunk is 'long'; it must be a number from 0.02 to 2 m"),
        (lengths_with(trunk=float("nan")), "trunk is nan"),
        (lengths_with(trunk=True), "trunk is True"),
        (lengths_with(neck_head=-0.2), r"neck_head is -0\.2"),
        (lengths_with(trunk=52.0), r"trunk is 52\.0"),
        (lengths_with(tail=0.3), r"unknown field 'tail'; known are upper_arm\.L"),
    ],
)
def test_unusable_lengths_are_refused_in_one_sentence(lengths: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        Actor(lengths)


@pytest.mark.parametrize("stature", [0.0, 175.0, float("nan"), float("inf")])
def test_an_impossible_stature_is_refused(stature: float) -> None:
    with pytest.raises(InputError, match="between 0.5 and 3 m"):
        Actor.from_stature(stature)


def leaning(degrees: float) -> Posture:
    """Standing, the left shin leaning backward by some degrees (the foot with it), the knee in its place."""
    vector = standing_posture(BODY).to_vector()
    vector[HUMAN.dof_names.index("hip.L.rotation_x")] = np.radians(-degrees)
    return Posture.from_vector(HUMAN, vector)


def test_who_stands_has_both_soles_flat_on_the_floor() -> None:
    pose = BODY.pose(Posture.stack([standing_posture(BODY)] * 2))
    places = sole_places(BODY, pose)
    assert places.shape == (2, 2, 2, 3)
    np.testing.assert_allclose(places[..., 2], 0.0, atol=1e-12)
    assert places[0, 0, 0, 0] > 0.0 > places[0, 1, 0, 0]
    assert (places[..., 0, 1] > places[..., 1, 1] + 0.2).all()


@pytest.mark.parametrize(("degrees", "lowest"), [(20.0, 0), (-20.0, 1)])
def test_a_leg_before_the_body_stands_on_its_heel_and_one_behind_on_its_toes(
    degrees: float, lowest: int
) -> None:
    pose = BODY.pose(leaning(degrees))
    heights = sole_places(BODY, pose)[0, :, 2]
    assert heights.argmin() == lowest and abs(np.ptp(heights)) > 0.05
    assert sole_heights_m(BODY, pose)[0] == heights.min()
    assert sole_heights_m(BODY, pose)[1] == pytest.approx(0.0, abs=1e-12)


def test_limbs_branch_off_the_trunk() -> None:
    names = [{HUMAN.dof_names[dof].rsplit(".", 1)[0] for dof in limb} for limb in HUMAN.limbs]
    assert names[0] == {"pelvis", "waist"}
    limbs = [("neck",), *((f"girdle.{side}", f"shoulder.{side}", f"elbow.{side}") for side in "LR")]
    limbs += [(f"hip.{side}", f"knee.{side}") for side in "LR"]
    assert len(names) == 1 + len(limbs)
    for limb in limbs:
        assert sum(set(limb) <= joints for joints in names[1:]) == 1
    assert sum(len(limb) for limb in HUMAN.limbs) == HUMAN.dof_count


def test_a_body_that_nobody_has_measured_is_known_as_one() -> None:
    average = Actor.from_stature(1.7).segments_m
    assert Actor(average).is_average
    assert not Actor({**average, "forearm.L": 1.01 * average["forearm.L"]}).is_average
    earlier = {"upper_arm": 0.186, "forearm": 0.146, "thigh": 0.245, "shin": 0.246}  # of Keymark 0.1.0
    shares = {name: earlier.get(name.split(".")[0], share) for name, share in SHARES_OF_STATURE.items()}
    assert Actor({name: 1.7 * share for name, share in shares.items()}).is_average
