"""The depth of postures that were put right in the picture alone."""

import numpy as np
import pytest
from _scene import BODY, CAMERA, exercise
from keymark.core.body.body_volume import lower_sole_m
from keymark.core.body.posture import Posture, yawed_at
from keymark.core.posing.picture_depth import seen_at, with_likely_depth
from keymark.core.prior.library import Library
from keymark.core.prior.registry import SHIPPED, find_libraries
from keymark.core.prior.texts import EVERY_LIBRARY

WRONG, SURE = 0.05, 0.98  # probabilities that what was found is about right


@pytest.fixture(scope="module")
def libraries() -> tuple[Library, ...]:
    return find_libraries(EVERY_LIBRARY, (SHIPPED,))


def performed(frame: int, turn_deg: float = 0.0) -> Posture:
    """A moment of an exercise on the floor, turned about the vertical."""
    moment = exercise(45)[np.array([frame])]
    placed = moment.translation - np.array([0.0, 0.0, 1.0]) * lower_sole_m(BODY, moment)[:, None]
    return yawed_at(moment, np.radians(turn_deg), placed)[0]


def dragged(found: Posture, truth: Posture) -> Posture:
    """What was found, with every point where the truth is seen."""
    return seen_at(BODY, CAMERA, 0, found, BODY.points(BODY.pose(truth)))


def error_m(posture: Posture, truth: Posture) -> float:
    """Mean distance of the points from the truth, hips aligned."""
    own, wanted = (BODY.points(BODY.pose(each)) - each.translation for each in (posture, truth))
    return float(np.linalg.norm(own - wanted, axis=-1).mean())


def off_px(posture: Posture, truth: Posture) -> float:
    """Largest distance in the picture of a point from where the truth is seen."""
    own, wanted = (CAMERA.project(BODY.points(BODY.pose(each)), 0)[0] for each in (posture, truth))
    return float(np.linalg.norm(own - wanted, axis=-1).max())


def test_a_body_found_turned_aside_turns_to_where_it_is_seen(libraries: tuple[Library, ...]) -> None:
    truth, found = performed(24), performed(24, 50.0)
    given = dragged(found, truth)
    assert error_m(given, truth) == pytest.approx(0.100, abs=0.01)
    likely = with_likely_depth(BODY, CAMERA, 0, given, found, WRONG, libraries, 0.0)
    assert error_m(likely, truth) < 0.05
    assert off_px(likely, truth) < 1.0


def test_depth_that_was_surely_found_stays(libraries: tuple[Library, ...]) -> None:
    truth, found = performed(24), performed(24, 6.0)
    given = dragged(found, truth)
    likely = with_likely_depth(BODY, CAMERA, 0, given, found, SURE, libraries, 0.0)
    assert error_m(likely, given) < 0.04
    assert off_px(likely, truth) < 0.2


def test_without_a_posture_to_ask_nothing_changes() -> None:
    given = performed(24)
    assert with_likely_depth(BODY, CAMERA, 0, given, given, WRONG, ()) is given
