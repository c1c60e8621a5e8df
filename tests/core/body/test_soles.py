"""Where the feet touch the floor."""

import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import sole_heights_m, sole_places, standing_posture
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture

BODY = Body(Actor.from_stature(1.8))


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
