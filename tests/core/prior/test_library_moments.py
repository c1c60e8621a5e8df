"""The tools that shipped libraries are composed with: balance, places on the floor, hands that reach."""

import sys
from pathlib import Path

import numpy as np
import pytest
from keymark.core.prior.library import Library, read_library

TOOLS = Path(__file__).resolve().parents[3] / "tools"
sys.path.insert(0, str(TOOLS))

from libraries.balance import balanced_over, center_of_mass, mass_of  # noqa: E402
from libraries.moment import Arm, Foot, Hand, Moment, Turn, mirrored, moment  # noqa: E402
from libraries.placing import moved, pivoted  # noqa: E402
from libraries.solving import BALL, BODY, posture_of  # noqa: E402

FOLDER = TOOLS.parent / "presets" / "keyframes"


def bowing(**others: object) -> Moment:
    """Somebody who bends down with bent knees, the left foot before the right."""
    return moment(
        left_leg=Foot(0.1, -0.2, 5.0),
        right_leg=Foot(-0.1, 0.1, -5.0, 20.0),
        bend=40.0,
        pelvis=Turn(bow=30.0, turn=10.0),
        waist=Turn(bow=25.0, lean=-8.0),
        **others,
    )


def points(posed: Moment) -> dict[str, np.ndarray]:
    """The principal points of a moment by name [m]."""
    return dict(zip(BODY.skeleton.point_names, BODY.points(BODY.pose(posture_of(posed))), strict=True))


@pytest.mark.parametrize(("x", "y"), [(0.0, -0.05), (0.06, -0.15), (-0.05, 0.02)])
def test_balance_puts_the_mass_over_the_place_and_leaves_the_feet(x: float, y: float) -> None:
    before, posed = points(bowing()), balanced_over(bowing(), x, y)
    after = points(posed)
    assert mass_of(posed)[:2] == pytest.approx([x, y], abs=1e-3)
    assert not np.allclose(before["head"], after["head"], atol=0.01)
    for ankle in ("ankle.L", "ankle.R"):
        assert after[ankle] == pytest.approx(before[ankle], abs=1e-6)


def test_a_moment_moved_is_the_same_elsewhere() -> None:
    posed = balanced_over(bowing(left_arm=Hand(0.2, -0.5, 0.7), right_arm=Arm(40.0, 60.0)), 0.0, -0.06)
    here, there = points(posed), points(moved(posed, 0.3, -1.2))
    for name in here:
        assert there[name] - here[name] == pytest.approx([0.3, -1.2, 0.0], abs=1e-9)


def test_a_foot_pivots_on_its_ball() -> None:
    foot = Foot(-0.1, 0.2, -50.0, 10.0)
    turned = pivoted(foot, -5.0, 40.0)
    ahead = -BALL[1] * BODY.actor.segments_m["foot.L"]

    def ball(of: Foot) -> np.ndarray:
        toes = np.radians(of.turn)
        return np.array([of.x, of.y]) + ahead * np.array([np.sin(toes), -np.cos(toes)])

    assert (turned.turn, turned.pitch) == (-5.0, 40.0)
    assert ball(turned) == pytest.approx(ball(foot), abs=1e-12)
    assert np.hypot(turned.x - foot.x, turned.y - foot.y) > 0.05


def test_a_hand_stays_short_of_a_place_only_where_it_may() -> None:
    far = Hand(-0.2, -0.8, 1.4, short=0.4)
    legs = Foot(0.1, 0.0)
    arm = points(moment(legs=legs, bend=8.0, right_arm=far))
    to_wrist, to_place = arm["wrist.R"] - arm["shoulder.R"], np.array([-0.2, -0.8, 1.4]) - arm["shoulder.R"]
    lengths = BODY.actor.segments_m
    assert np.linalg.norm(to_wrist) == pytest.approx(0.98 * (lengths["upper_arm.R"] + lengths["forearm.R"]))
    assert np.cross(to_wrist, to_place) == pytest.approx(np.zeros(3), abs=1e-9)
    for place in (Hand(-0.2, -0.8, 1.4), Hand(-0.2, -1.4, 1.4, short=0.4)):
        with pytest.raises(ValueError, match="beyond its arm's length"):
            posture_of(moment(legs=legs, bend=8.0, right_arm=place))


def test_a_mirrored_moment_is_the_mirror_image() -> None:
    posed = bowing(left_arm=Hand(0.2, -0.5, 0.7))
    here, there = points(posed), points(mirrored(posed))
    for name, place in here.items():
        other = {"L": name[:-1] + "R", "R": name[:-1] + "L"}.get(name[-1] if "." in name else "", name)
        assert there[other] == pytest.approx(place * [-1.0, 1.0, 1.0], abs=1e-9)


def shipped(name: str) -> Library:
    return read_library(FOLDER / f"{name}.json")


def test_who_stands_on_one_leg_could_stay_there() -> None:
    library = shipped("balance")
    held = [posture for posture in library.postures if "one leg" in posture.tags]
    assert len(held) >= 12
    foot = BODY.actor.segments_m["foot.R"]
    for posture in held:
        pose = BODY.pose(posture.posture)
        ankle = BODY.points(pose)[BODY.skeleton.point_names.index("ankle.R")]
        mass = center_of_mass(BODY, pose)
        assert abs(mass[0] - ankle[0]) < 0.04, posture.name
        assert -0.66 * foot < mass[1] - ankle[1] < 0.29 * foot, posture.name


@pytest.mark.parametrize(
    "name", ["aerobic", "squatting_lifting", "reaching", "waving", "punching", "balance"]
)
def test_people_begin_and_end_in_standing(name: str) -> None:
    library = shipped(name)
    standing = library.by_name["standing"].posture
    at = dict(zip(BODY.skeleton.point_names, BODY.points(BODY.pose(standing)), strict=True))
    assert at["head"][2] > 1.5
    assert np.hypot(*(at["head"] - at["ankle.L"])[:2]) < 0.2
    assert any(
        "standing" in (motion.steps[0].posture, motion.steps[-1].posture) for motion in library.motions
    )


def test_fists_meet_their_targets_and_come_back() -> None:
    library = shipped("punching")
    wrist = BODY.skeleton.point_names.index

    def ahead(posture: str, side: str) -> float:
        pose = BODY.pose(library.by_name[posture].posture)
        return -float(BODY.points(pose)[wrist(f"wrist.{side}"), 1])

    for punch, side in (("jab", "L"), ("cross", "R"), ("jab to the body", "L")):
        assert ahead(punch, side) > ahead("guard", side) + 0.25
        motion = next(motion for motion in library.motions if motion.name == punch)
        assert motion.steps[0].posture == motion.steps[-1].posture == "guard"


def test_the_hand_reaches_the_floor_and_the_shelf() -> None:
    library = shipped("reaching")
    hand = BODY.actor.segments_m["hand.R"]
    for name in ("floor", "floor, to the right", "floor, to the left", "both hands: floor"):
        assert wrist_height(library, name) < 0.75 * hand + 0.25, name
    for name in ("shelf", "high shelf", "both hands: shelf"):
        assert wrist_height(library, name) > 1.75, name


def wrist_height(library: Library, name: str) -> float:
    """Of the right wrist [m]."""
    pose = BODY.pose(library.by_name[name].posture)
    return float(BODY.points(pose)[BODY.skeleton.point_names.index("wrist.R"), 2])
