"""A library's postures on other proportions, and seen in a mirror."""

from dataclasses import replace

import numpy as np
import pytest
from _libraries import ACTOR, random_posture, small_library
from _library_strategies import libraries
from hypothesis import HealthCheck, given, settings
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import sole_heights_m, standing_posture
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.mirror import MIRROR, mirrored
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.core.prior.library import Library, LibraryPosture
from keymark.core.prior.motion_playback import sample_motion
from keymark.core.prior.transfer import (
    leg_length_m,
    mirrored_library,
    mirrored_name,
    transferred,
    with_mirrored,
)

OWN = Body(ACTOR)
LENGTHS = dict(ACTOR.segments_m)


def grounded(seed: int, height_m: float) -> Posture:
    """A posture whose lowest sole is `height_m` above the floor."""
    posture = random_posture(seed)
    lift = height_m - sole_heights_m(OWN, OWN.pose(posture)).min()
    return Posture(HUMAN, posture.translation + [0.0, 0.0, lift], posture.rotations, posture.angles)


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
    body = Body(Actor(lengths))
    scale = leg_length_m(body.actor) / leg_length_m(ACTOR)
    posture = grounded(2, height_m)
    fitted = transferred(LibraryPosture("any", posture), ACTOR, body)
    assert sole_heights_m(body, body.pose(fitted)).min() == pytest.approx(scale * height_m, abs=1e-12)
    np.testing.assert_array_equal(fitted.rotations, posture.rotations)
    np.testing.assert_allclose(fitted.translation[:2], scale * posture.translation[:2])


def test_a_child_does_what_an_adult_does() -> None:
    child = Body(Actor({name: 0.7 * length for name, length in LENGTHS.items()}))
    batch = Posture.stack([grounded(seed, 0.05 * seed) for seed in range(4)])
    small = transferred(batch, ACTOR, child)
    np.testing.assert_allclose(child.points(child.pose(small)), 0.7 * OWN.points(OWN.pose(batch)), atol=1e-12)
    back = transferred(small, child.actor, OWN)
    np.testing.assert_allclose(back.translation, batch.translation, atol=1e-12)


LIBRARY = small_library()


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("Left foot lands", "Right foot lands"),
        ("turn right, LEFT foot", "turn left, RIGHT foot"),
        ("kick_left", "kick_right"),
        ("Hook.L", "Hook.R"),
        ("Step L to R", "Step R to L"),
        ("Upright, leftover Lunge", "Upright, leftover Lunge"),
    ],
)
def test_sides_in_names_are_exchanged(name: str, other: str) -> None:
    assert mirrored_name(name) == other
    assert mirrored_name(other) == name


@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow])
@given(libraries())
def test_any_library_can_be_mirrored(library: Library) -> None:
    library = Library.from_json(library.to_json(), "here")
    for result in (mirrored_library(library), with_mirrored(library)):
        written = result.to_json()
        assert Library.from_json(written, "here").to_json() == written


def test_a_mirrored_motion_runs_as_in_a_mirror() -> None:
    times = np.linspace(0.0, 3.7, 30)
    body = Body(ACTOR)
    there = sample_motion(LIBRARY, LIBRARY.motions[0], body, times)
    other = mirrored_library(LIBRARY)
    here = sample_motion(other, other.motions[0], body, times)
    np.testing.assert_allclose(here.minus(mirrored(there)), 0.0, atol=1e-9)
    assert (there.translation * MIRROR)[-1] == pytest.approx(here.translation[-1])


def test_what_lacks_its_other_side_gets_it_and_nothing_twice() -> None:
    standing = LibraryPosture("Stand", standing_posture(Body(ACTOR)))
    library = replace(LIBRARY, postures=(*LIBRARY.postures, standing))
    both = with_mirrored(library)
    names = [posture.name for posture in both.postures]
    assert names[4:] == ["Right foot lands 2", "Stand on one leg (mirrored)", "Left foot lands 2"]
    assert [motion.name for motion in both.motions][2:] == ["Steps (mirrored)", "Once (mirrored)"]
    assert both.motions[2].steps[0].posture == "Right foot lands 2"
    assert with_mirrored(both).to_json() == both.to_json()


def test_uneven_sides_are_refused() -> None:
    with pytest.raises(InputError, match="differ in length"):
        with_mirrored(replace(LIBRARY, actor=Actor(dict(ACTOR.segments_m) | {"shin.L": 0.4})))
