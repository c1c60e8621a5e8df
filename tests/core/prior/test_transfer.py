"""A library's posture on other proportions."""

import numpy as np
import pytest
from _libraries import ACTOR, random_posture
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import sole_heights_m
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.prior.library import LibraryPosture
from keymark.core.prior.transfer import leg_length_m, transferred

OWN = Body(ACTOR)
LENGTHS = dict(ACTOR.segments_m)


def grounded(seed: int, height_m: float) -> Posture:
    """A posture whose lowest sole is `height_m` above the floor."""
    posture = random_posture(seed)
    lift = height_m - sole_heights_m(OWN, OWN.pose(posture)).min()
    return Posture(HUMAN, posture.translation + [0.0, 0.0, lift], posture.rotations, posture.angles)


def test_the_same_proportions_get_the_same_posture() -> None:
    """Not even the last bit changes, whoever has been read from a file in between."""
    posture = random_posture(1)
    nearly = Actor({name: round(length, 9) for name, length in LENGTHS.items()})
    assert transferred(posture, ACTOR, Body(nearly)) is posture


@pytest.mark.parametrize(
    "lengths",
    [
        dict(Actor.from_stature(1.5).segments_m),
        LENGTHS | {"shin.L": 0.5, "shin.R": 0.5, "foot.L": 0.25, "foot.R": 0.25},
        LENGTHS | {"thigh.L": 0.3, "trunk": 0.7},
    ],
)
@pytest.mark.parametrize("height_m", [0.0, 0.2])
def test_feet_stay_on_the_floor_or_as_far_above(lengths: dict[str, float], height_m: float) -> None:
    """The lowest sole is as high as legs are long; angles stay, ways are scaled."""
    body = Body(Actor(lengths))
    scale = leg_length_m(body.actor) / leg_length_m(ACTOR)
    posture = grounded(2, height_m)
    fitted = transferred(LibraryPosture("any", posture), ACTOR, body)
    assert sole_heights_m(body, body.pose(fitted)).min() == pytest.approx(scale * height_m, abs=1e-12)
    np.testing.assert_array_equal(fitted.rotations, posture.rotations)
    np.testing.assert_allclose(fitted.translation[:2], scale * posture.translation[:2])


def test_a_child_does_what_an_adult_does() -> None:
    """With all lengths scaled alike, every point is scaled; there and back again nothing has changed."""
    child = Body(Actor({name: 0.7 * length for name, length in LENGTHS.items()}))
    batch = Posture.stack([grounded(seed, 0.05 * seed) for seed in range(4)])
    small = transferred(batch, ACTOR, child)
    np.testing.assert_allclose(child.points(child.pose(small)), 0.7 * OWN.points(OWN.pose(batch)), atol=1e-12)
    back = transferred(small, child.actor, OWN)
    np.testing.assert_allclose(back.translation, batch.translation, atol=1e-12)
