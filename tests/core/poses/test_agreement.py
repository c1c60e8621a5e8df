"""Checks of poses that nobody posed: the detector's sizes, the floor, limbs that are never seen."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _performed import BODY, FRAMES, camera, detected, performed, unmarked
from keymark.core.body.posture import Posture
from keymark.core.estimate.performer_placement import feet_over_floor_m
from keymark.core.poses.agreement import GUESSED_SIZE, agreement
from keymark.core.poses.clip_input import PosingInput, posing_input
from keymark.core.poses.found_poses import Candidate, MatchedFrame
from keymark.core.prior.registry import SHIPPED, find_libraries
from keymark.core.session.stages import seen_in


@cache
def truth() -> Posture:
    (walking,) = find_libraries("walking", [SHIPPED])
    return performed(walking, np.radians(35.0))


@cache
def seen(hinted: bool = True, size: float = 1.0) -> PosingInput:
    """What is seen, with hints of somebody so much larger than networks have somebody of that height."""
    people = detected(truth(), camera())
    given = posing_input(seen_in(*unmarked(truth(), camera(), people if hinted else people.without_hints())))
    known = given.evidence.keypoints
    sized = replace(known, hint_m=size * GUESSED_SIZE * known.hint_m)
    return replace(given, evidence=replace(given.evidence, keypoints=sized))


def frames(confidence: float = 0.9) -> list[MatchedFrame]:
    return [MatchedFrame(row, (Candidate(truth()[row], "", False, confidence),)) for row in (0, FRAMES - 1)]


def on_floor() -> float:
    points = BODY.points(BODY.pose(truth()))[seen().sampled]
    return feet_over_floor_m(BODY, points, 0.0)


def test_what_agrees_is_usable() -> None:
    probability, said = agreement(seen(), truth(), frames(), on_floor())
    assert probability == pytest.approx(0.85, abs=0.03)
    assert (
        said
        == f"the found poses are usable, {probability:.0%} sure: the detector's sizes and the floor agree"
    )


def test_the_postures_probability_enters() -> None:
    sure, unsure = (agreement(seen(), truth(), frames(one), on_floor())[0] for one in (0.9, 0.3))
    assert unsure == pytest.approx(sure / 3.0)
    assert "doubtful" in agreement(seen(), truth(), frames(0.3), on_floor())[1]


@pytest.mark.parametrize(("off_m", "where"), [(0.25, "above"), (-0.25, "below")])
def test_feet_off_the_floor_are_doubtful(off_m: float, where: str) -> None:
    probability, said = agreement(seen(), truth(), frames(), on_floor() - off_m)
    assert probability == 0.02
    assert said == f"the found poses are doubtful, 2% sure: the feet are 25 cm {where} the floor"


def test_an_open_floor_is_not_checked() -> None:
    probability, said = agreement(seen(hinted=False), truth(), frames(), None)
    assert (probability, said) == (pytest.approx(0.9), "the found poses are usable, 90% sure")


def test_a_performer_of_another_size_is_doubtful() -> None:
    probability, said = agreement(seen(size=0.82), truth(), frames(), on_floor())
    assert probability < 0.5
    assert "by the detector's guess in space the performer is 17% shorter than stated" in said


def test_who_is_away_for_half_of_the_clip_leaves_half_of_it_usable() -> None:
    given = replace(seen(), share=0.5)
    probability, said = agreement(given, truth(), frames(), on_floor())
    assert probability == pytest.approx(0.5 * agreement(seen(), truth(), frames(), on_floor())[0], rel=0.03)
    assert said.endswith("nobody is seen in 50% of the frames")


def test_limbs_that_are_never_seen_are_named() -> None:
    given = replace(seen(), unseen=("leg.L", "leg.R"))
    probability, said = agreement(given, truth(), frames(), on_floor())
    assert probability == pytest.approx(0.25 * 0.9, abs=0.03)
    assert said.endswith("the legs are never seen")
