"""Keyframes that a person posed, among those of a take."""

import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.posing.posing_input import PosedFrames
from keymark.core.prior.keyframes import Keyframe, Matched
from keymark.core.prior.library import read_library
from keymark.core.prior.registry import SHIPPED

BODY = Body(Actor.from_stature(1.7))


def test_only_what_a_person_posed_counts_as_posed() -> None:
    library = read_library(SHIPPED / "squatting_lifting.json")
    low, other = (each.posture for each in library.postures[:2])
    raised = Posture(low.skeleton, low.translation + np.array([0.0, 0.0, 0.4]), low.rotations, low.angles)
    said = Matched("squatting_lifting", library.postures[1].name, False, 0.9)
    posed = PosedFrames.of(BODY, [Keyframe(9, raised), Keyframe(5, other, matched=said), Keyframe(2, raised)])
    assert posed.frames.tolist() == [2, 9]
    assert np.array_equal(posed.hips[1], raised.translation)
    lowest = PosedFrames.of(BODY, [Keyframe(0, low)]).floor_m()
    assert lowest is not None
    assert posed.floor_m() == pytest.approx(lowest + 0.4)
    assert PosedFrames.of(BODY, []).floor_m() is None
