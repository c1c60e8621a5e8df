"""Libraries seen in a mirror."""

from dataclasses import replace

import numpy as np
import pytest
from _libraries import ACTOR, small_library
from _library_strategies import libraries
from hypothesis import HealthCheck, given, settings
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.kinematics import Body
from keymark.core.body.mirror import MIRROR, mirrored
from keymark.core.errors import InputError
from keymark.core.prior.library import Library, LibraryPosture
from keymark.core.prior.motion_playback import sample_motion
from keymark.core.prior.transfer import mirrored_library, mirrored_name, with_mirrored

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
    """Whole words and letters that stand alone, and back again."""
    assert mirrored_name(name) == other
    assert mirrored_name(other) == name


@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow])
@given(libraries())
def test_any_library_can_be_mirrored(library: Library) -> None:
    """The mirrored library is valid and reads back as it was written; so does the one with both sides."""
    library = Library.from_json(library.to_json(), "here")
    for result in (mirrored_library(library), with_mirrored(library)):
        written = result.to_json()
        assert Library.from_json(written, "here").to_json() == written


def test_mirrored_twice_is_the_same() -> None:
    uneven = replace(LIBRARY, actor=Actor(dict(ACTOR.segments_m) | {"shin.L": 0.4}))
    assert mirrored_library(mirrored_library(uneven)).to_json() == uneven.to_json()
    assert mirrored_library(uneven).actor.segments_m["shin.R"] == 0.4
    assert mirrored_library(uneven).identifier == "small_steps_mirrored"


def test_a_mirrored_motion_runs_as_in_a_mirror() -> None:
    """Over several cycles, turning and travelling to the other side."""
    times = np.linspace(0.0, 3.7, 30)
    body = Body(ACTOR)
    there = sample_motion(LIBRARY, LIBRARY.motions[0], body, times)
    other = mirrored_library(LIBRARY)
    here = sample_motion(other, other.motions[0], body, times)
    np.testing.assert_allclose(here.minus(mirrored(there)), 0.0, atol=1e-9)
    assert (there.translation * MIRROR)[-1] == pytest.approx(here.translation[-1])


def test_what_lacks_its_other_side_gets_it_and_nothing_twice() -> None:
    """Postures and motions are added once; what is alike on both sides is not."""
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
