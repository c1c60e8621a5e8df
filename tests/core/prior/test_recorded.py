"""What is believed beforehand, number by number."""

import numpy as np
from _libraries import random_posture, sample_motion
from _performances import stepping
from _recorded import assert_recorded
from _scene import BODY, CAMERA, SEGMENTS, exercise, film
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.prior.frame_prior import (
    difference_std,
    prior_from_keyframes,
    process_noise_factor,
    unrelated_std,
)
from keymark.core.prior.keyframe_proposals import marker_speed, propose_keyframes
from keymark.core.prior.keyframes import (
    Keyframe,
    Matched,
    found_doubt,
    interpolate,
    with_turns,
)
from keymark.core.prior.learning import LibraryMetadata, learn_library, shape_vectors, spread_frames
from keymark.core.prior.library import transferred
from keymark.core.prior.registry import SHIPPED, find_library

KEYFRAMES = tuple(Keyframe(index, exercise(60)[index]) for index in (0, 9, 21, 30, 44, 59))
PERFORMER, STEPS = stepping()
TIME_S = np.arange(STEPS.batch[0]) / 30.0


def test_keyframes() -> None:
    between = interpolate(KEYFRAMES, 60)
    assert_recorded("between keyframes", between.to_vector())
    indices = np.array([keyframe.index for keyframe in KEYFRAMES])
    assert_recorded("turns", with_turns(between, indices, np.array([0, 1, 0, -1, 0])).to_vector())
    found = Matched("walking", "Step", False, 0.7)
    rng = np.random.default_rng(6)
    shaken = tuple(
        Keyframe(one.index, one.posture.plus(0.03 * rng.normal(size=HUMAN.dof_count)), 0.0, said)
        for one, said in zip(KEYFRAMES, (None, found, found, None, found, None), strict=True)
    )
    assert_recorded("doubt", found_doubt(shaken, 30.0), share=1e-4)


def test_a_frames_prior() -> None:
    for name, count, frame in (("beside", 1, 7), ("between", 6, 25), ("beyond", 4, 40)):
        prior = prior_from_keyframes(KEYFRAMES[:count], frame, 30.0)
        assert_recorded(f"prior {name}", prior.posture.to_vector())
        assert_recorded(f"prior {name}, deviation", prior.std)
    assert_recorded("differences", difference_std(HUMAN, 0.4), unrelated_std(HUMAN))
    assert_recorded("process noise", process_noise_factor(exercise(30), np.arange(30) / 25.0))
    assert_recorded("process noise, one", process_noise_factor(exercise(1), np.zeros(1)))


def test_proposals() -> None:
    tracks = film(exercise(90), 0.3)
    speed = marker_speed(tracks)
    assert len(SEGMENTS) == tracks.centroid.shape[1] and CAMERA.resolution == tracks.size
    assert_recorded("speed", speed)
    assert_recorded("proposed", propose_keyframes(speed), propose_keyframes(speed, largest_gap=6))


def test_what_is_learned() -> None:
    shape = shape_vectors(PERFORMER, STEPS)
    assert_recorded("shapes", shape)
    assert_recorded("spread", spread_frames(shape, TIME_S, float(TIME_S[-1]), None))
    walking = find_library("walking", (SHIPPED,))
    times = np.arange(120) / 30.0
    walk = sample_motion(walking, walking.motions[0], Body(walking.actor), times)
    library = learn_library(Body(walking.actor), walk, times, LibraryMetadata("Walk", "A. Person"))
    assert_recorded("learned", *(one.posture.to_vector() for one in library.postures), share=1e-4)
    assert_recorded("learned, times", [step.time_s for motion in library.motions for step in motion.steps])


def test_other_bodies() -> None:
    walking = find_library("walking", (SHIPPED,))
    own = [transferred(one.posture, walking.actor, BODY).to_vector() for one in walking.postures]
    assert_recorded("transferred 0", *own, share=1e-4)
    assert_recorded("random", random_posture(5).to_vector())
