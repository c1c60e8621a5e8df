"""Checks of poses that nobody posed: the detector's sizes, the floor, limbs that are never seen."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _performed import BODY, FRAMES, camera, detected, performed, unmarked
from keymark.core.body.posture import Posture
from keymark.core.estimate.performer_placement import feet_over_floor_m
from keymark.core.poses.agreement import agreement
from keymark.core.poses.candidates import Candidate, MatchedFrame
from keymark.core.poses.clip_input import PosingInput, posing_input
from keymark.core.prior.registry import SHIPPED, find_libraries
from keymark.core.session.stages import seen_in


@cache
def truth() -> Posture:
    (walking,) = find_libraries("walking", [SHIPPED])
    return performed(walking, np.radians(35.0))


@cache
def seen(hinted: bool = True) -> PosingInput:
    people = detected(truth(), camera())
    return posing_input(seen_in(*unmarked(truth(), camera(), people if hinted else people.without_hints())))


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
    given = seen()
    known = given.evidence.keypoints
    small = replace(given.evidence, keypoints=replace(known, hint_m=0.6 * known.hint_m))
    probability, said = agreement(replace(given, evidence=small), truth(), frames(), on_floor())
    assert probability < 0.2
    assert "by the detector's guess in space the performer is 39% shorter than stated" in said


def test_limbs_that_are_never_seen_are_named() -> None:
    given = replace(seen(), unseen=("leg.L", "leg.R"))
    probability, said = agreement(given, truth(), frames(), on_floor())
    assert probability == pytest.approx(0.25 * 0.9, abs=0.03)
    assert said.endswith("the legs are never seen")
