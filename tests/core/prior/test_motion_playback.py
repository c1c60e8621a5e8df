"""A motion that runs on."""

from dataclasses import replace

import numpy as np
import pytest
from _libraries import ACTOR, small_library
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import sole_heights_m
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.prior.library import Library, LibraryPosture
from keymark.core.prior.motion_playback import after_cycles, sample_motion

BODY = Body(ACTOR)


def standing_library() -> Library:
    """The small library, every posture's lowest sole on the floor."""
    library = small_library()

    def lowered(posture: Posture) -> Posture:
        down = sole_heights_m(BODY, BODY.pose(posture)).min() * np.array([0.0, 0.0, 1.0])
        return Posture(posture.skeleton, posture.translation - down, posture.rotations, posture.angles)

    postures = tuple(LibraryPosture(p.name, lowered(p.posture)) for p in library.postures)
    return replace(library, postures=postures)


LIBRARY = standing_library()
STEPS, ONCE = LIBRARY.motions


def test_the_course_passes_through_its_steps() -> None:
    times = np.array([step.time_s for step in STEPS.steps])
    here, later = (sample_motion(LIBRARY, STEPS, BODY, times + n * STEPS.duration_s) for n in (0, 1))
    posed = Posture.stack([LIBRARY.by_name[step.posture].posture for step in STEPS.steps])
    np.testing.assert_allclose(here.minus(posed), 0.0, atol=1e-9)
    np.testing.assert_allclose(later.angles, posed.angles, atol=1e-9)
    x, y, heading = STEPS.travel
    turn = np.array(
        [[np.cos(heading), -np.sin(heading), 0], [np.sin(heading), np.cos(heading), 0], [0, 0, 1]]
    )
    np.testing.assert_allclose(later.translation, posed.translation @ turn.T + [x, y, 0.0], atol=1e-9)
    np.testing.assert_allclose(later.rotations[:, 0], turn @ posed.rotations[:, 0], atol=1e-9)


@pytest.mark.parametrize("heading", [0.0, 1e-12, 0.3, np.pi, 2.0 * np.pi, -3.5 * np.pi])
def test_cycles_add_up(heading: float) -> None:
    motion = replace(STEPS, travel=(0.2, -1.1, heading))
    start = Posture.stack([LIBRARY.postures[0].posture])
    one = np.array([1.0])
    walked = start
    for _ in range(5):
        walked = after_cycles(walked, motion, one)
    np.testing.assert_allclose(after_cycles(start, motion, 5 * one).minus(walked), 0.0, atol=1e-7)
    np.testing.assert_allclose(after_cycles(walked, motion, -5 * one).minus(start), 0.0, atol=1e-7)


def test_nothing_jumps_where_cycles_meet() -> None:
    step = 1e-4
    times = 3.0 * STEPS.duration_s + step * np.arange(-2, 3)
    speed = np.diff(BODY.points(BODY.pose(sample_motion(LIBRARY, STEPS, BODY, times))), axis=0) / step
    assert np.abs(np.diff(speed, axis=0)).max() < 0.05
    assert np.abs(speed).max() > 0.05


def test_what_stands_on_the_floor_stays_there() -> None:
    times = np.linspace(-1.0, 2.5, 200)
    for body in (BODY, Body(Actor.from_stature(1.3))):
        heights = sole_heights_m(body, body.pose(sample_motion(LIBRARY, STEPS, body, times))).min(axis=-1)
        np.testing.assert_allclose(heights, 0.0, atol=1e-9)


def test_a_motion_that_ends_is_held() -> None:
    held = sample_motion(LIBRARY, ONCE, BODY, np.array([-1.0, 0.0, 0.31, 0.5, 9.0]))
    np.testing.assert_allclose(held[0].minus(held[1]), 0.0, atol=1e-12)
    np.testing.assert_allclose(held[2].minus(held[4]), 0.0, atol=1e-12)
    alone = replace(ONCE, steps=ONCE.steps[:1])
    assert sample_motion(LIBRARY, alone, BODY, np.linspace(0.0, 2.0, 5)).batch == (5,)
    circling = replace(STEPS, steps=STEPS.steps[:1])
    places = sample_motion(LIBRARY, circling, BODY, np.arange(4.0)).translation
    ways = np.linalg.norm(np.diff(places, axis=0), axis=-1)
    assert np.ptp(ways) < 1e-9 and ways[0] > 1.0
