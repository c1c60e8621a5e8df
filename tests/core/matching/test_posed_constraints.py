"""Constraints from posed keyframes on the states of a library."""

import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.heading import yawed_at
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.library.library import Library
from keymark.core.library.library_file import read_library
from keymark.core.library.registry import SHIPPED
from keymark.core.matching.posed_constraints import PosedConstraints
from keymark.core.prior.keyframes import Keyframe, Matched

BODY = Body(Actor.from_stature(1.7))
HEADINGS = 2.0 * np.pi * np.arange(24) / 24


@pytest.fixture(scope="module")
def library() -> Library:
    """A shipped library."""
    return read_library(SHIPPED / "squatting_lifting.json")


def shapes(library: Library) -> tuple[Posture, np.ndarray]:
    """The library's postures, and their points relative to the hips."""
    postures = Posture.stack([each.posture for each in library.postures])
    return postures, BODY.points(BODY.pose(postures)) - postures.translation[:, None]


def test_a_posed_posture_is_its_own_in_its_own_heading(library: Library) -> None:
    """Of all postures and headings the one that was posed costs least, by what usually is left over."""
    postures, points = shapes(library)
    for which, heading in ((0, 5), (7, 17)):
        turned = yawed_at(postures[[which]], HEADINGS[[heading]], np.array([[0.3, -0.4, 0.9]]))[0]
        constraints = PosedConstraints.from_keyframes(BODY, [Keyframe(4, turned)])
        cost = constraints.cost(4, points, HEADINGS)
        assert cost is not None
        assert divmod(int(cost.argmin()), len(HEADINGS)) == (which, heading)
        assert cost.min() == pytest.approx(-2.5, abs=0.01)
        assert constraints.cost(5, points, HEADINGS) is None


def test_only_what_a_person_posed_is_a_constraint(library: Library) -> None:
    """Matched keyframes say nothing new; the posed ones come in order, and the lowest sole is the floor."""
    postures, _ = shapes(library)
    said = Matched("squatting_lifting", library.postures[1].name, False, 0.9)
    raised = Posture(
        postures[0].skeleton,
        postures[0].translation + np.array([0.0, 0.0, 0.4]),
        postures[0].rotations,
        postures[0].angles,
    )
    keyframes = [Keyframe(9, raised), Keyframe(5, postures[1], matched=said), Keyframe(2, raised)]
    constraints = PosedConstraints.from_keyframes(BODY, keyframes)
    assert constraints.frames.tolist() == [2, 9]
    assert constraints.hips_at(5) is None
    assert np.array_equal(constraints.hips_at(9), raised.translation)
    lowest = PosedConstraints.from_keyframes(BODY, [Keyframe(0, postures[0])]).floor_m()
    assert lowest is not None
    assert constraints.floor_m() == pytest.approx(lowest + 0.4)
    assert PosedConstraints.from_keyframes(BODY, []).floor_m() is None
