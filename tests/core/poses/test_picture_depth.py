"""Where postures lean that were put right in the picture alone."""

from dataclasses import replace

import numpy as np
import pytest
from _scene import BODY, CAMERA, exercise
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import lower_sole_m
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture, yawed_at
from keymark.core.poses.dragged import dragged
from keymark.core.poses.picture_depth import put_right
from keymark.core.prior.library import Library
from keymark.core.prior.registry import SHIPPED, find_libraries
from keymark.core.prior.texts import EVERY_LIBRARY

WRONG, SURE = 0.05, 0.98  # probabilities that what was found is about right
NAMES = BODY.skeleton.point_names
AVERAGE = Body(Actor.from_stature(BODY.actor.stature_m))
LONGER = {"upper_arm": 1.05, "forearm": 0.96, "thigh": 0.96, "shin": 1.04}
OWN = {name: own * LONGER.get(name.split(".")[0], 1.0) for name, own in AVERAGE.actor.segments_m.items()}
PERFORMER = Body(Actor(OWN))
"""Somebody as tall whose limbs are others than the average."""
MEASURED = Body(Actor({**AVERAGE.actor.segments_m, "hand.L": 0.2}))
"""Average lengths that are taken for a performer's own."""


@pytest.fixture(scope="module")
def libraries() -> tuple[Library, ...]:
    return find_libraries(EVERY_LIBRARY, (SHIPPED,))


def performed(frame: int, turn_deg: float = 0.0) -> Posture:
    """A moment of an exercise on the floor, turned about the vertical."""
    moment = exercise(45)[np.array([frame])]
    placed = moment.translation - np.array([0.0, 0.0, 1.0]) * lower_sole_m(BODY, moment)[:, None]
    return yawed_at(moment, np.radians(turn_deg), placed)[0]


def points(posture: Posture, body: Body = PERFORMER) -> Array:
    return body.points(body.pose(posture))


def set_right(
    found: Posture,
    seen: Array,
    confidence: float,
    libraries: tuple[Library, ...],
    body: Body = PERFORMER,
) -> Posture:
    """What was found, with all points set where places (P, 3) are seen."""
    places = dict(zip(NAMES, seen, strict=True))
    return put_right(body, CAMERA, 0, found, found, places, confidence, libraries, 0.0)


def error_m(posture: Posture, truth: Array, body: Body = PERFORMER) -> float:
    """Mean distance of the points from true ones, hips aligned."""
    hips = [NAMES.index(f"hip.{side}") for side in "LR"]
    own = points(posture, body)
    rooted = [each - each[hips].mean(axis=0) for each in (own, truth)]
    return float(np.linalg.norm(rooted[0] - rooted[1], axis=-1).mean())


def off_px(posture: Posture, places: Array, body: Body = PERFORMER) -> Array:
    """(P,) distances in the picture of points from where places are seen."""
    own, wanted = (CAMERA.project(each, 0)[0] for each in (points(posture, body), places))
    return np.asarray(np.linalg.norm(own - wanted, axis=-1))


def test_a_body_found_turned_aside_turns_to_where_it_is_seen(libraries: tuple[Library, ...]) -> None:
    truth, found = points(performed(24)), performed(24, 50.0)
    assert error_m(found, truth) == pytest.approx(0.231, abs=0.01)
    likely = set_right(found, truth, WRONG, libraries)
    assert error_m(likely, truth) < 0.06
    assert off_px(likely, truth).max() < 2.5


def test_depth_that_was_surely_found_stays(libraries: tuple[Library, ...]) -> None:
    truth, found = points(performed(24)), performed(24, 6.0)
    likely = set_right(found, truth, SURE, libraries)
    assert error_m(likely, points(found)) < 0.04
    assert off_px(likely, truth).max() < 2.5


def test_average_lengths_do_not_make_a_right_body_lean(libraries: tuple[Library, ...]) -> None:
    """Without the performer's lengths nothing is sought: what was right stays right."""
    truth, found = points(performed(24)), performed(24)
    likely = set_right(found, truth, SURE, libraries, AVERAGE)
    assert error_m(likely, truth, AVERAGE) < error_m(found, truth, AVERAGE) + 0.002
    assert error_m(set_right(found, truth, SURE, libraries, MEASURED), truth, MEASURED) > 0.02
    assert off_px(likely, truth, AVERAGE).max() < off_px(found, truth, AVERAGE).max()
    without = set_right(found, truth, SURE, (), AVERAGE)
    assert np.array_equal(likely.minus(without), np.zeros(BODY.skeleton.dof_count))


@pytest.mark.parametrize("body", [AVERAGE, PERFORMER], ids=["average", "measured"])
def test_the_point_under_the_mouse_stays_there(body: Body, libraries: tuple[Library, ...]) -> None:
    """Others that were set before come near to their places, and what was not set hardly moves."""
    found = performed(24)
    places = points(found, body)
    wrist, head = NAMES.index("wrist.L"), NAMES.index("head")
    places[head] += [0.03, 0.0, 0.0]
    places[wrist] += [0.0, 0.0, 0.15]
    _, eye = CAMERA.pose(0)
    sight = (places[wrist] - eye) / np.linalg.norm(places[wrist] - eye)
    shown = dragged(body, found, "wrist.L", places[wrist], sight)
    chosen = {"head": places[head], "wrist.L": places[wrist]}
    likely = put_right(body, CAMERA, 0, found, shown, chosen, 0.8, libraries, 0.0, "wrist.L")
    off = off_px(likely, places, body)
    assert off[wrist] < 0.3 and off[head] < 3.0
    legs = [NAMES.index(f"{joint}.{side}") for joint in ("knee", "ankle") for side in "LR"]
    assert np.linalg.norm(points(likely, body) - points(found, body), axis=-1)[legs].max() < 0.065


def test_lengths_are_average_until_one_is_measured() -> None:
    assert Actor.from_stature(1.72).is_average
    assert not replace(AVERAGE.actor, segments_m={**AVERAGE.actor.segments_m, "upper_arm.L": 0.31}).is_average
