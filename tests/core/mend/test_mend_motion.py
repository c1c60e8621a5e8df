"""Motions mended without footage: steady, standing on their feet, with their sides right, as posed."""

import numpy as np
import pytest
from _performances import ANKLES, HIPS, RATE, about_hips, error_mm, jitter_mm, seen_by_network, stepping
from keymark.core.arrays import Array
from keymark.core.body.body_volume import sole_offsets
from keymark.core.body.mirror import OPPOSITE
from keymark.core.errors import InputError
from keymark.core.feet.place_by_feet import place_by_feet
from keymark.core.mend.mend_motion import (
    Mended,
    MendOptions,
    exchanged_frames,
    measured_actor,
    mend_motion,
)
from keymark.core.progress import run

FRAMES = slice(0, 90)


@pytest.fixture(scope="module")
def truth() -> Array:
    """(F, 13, 3) true points."""
    body, posture = stepping()
    return body.points(body.pose(posture[FRAMES]))


@pytest.fixture(scope="module")
def mended(truth: Array) -> Mended:
    """What a network saw of them, mended."""
    return run(mend_motion(seen_by_network(truth), RATE, MendOptions()))


def slide_mm(points: Array, truth: Array) -> float:
    """Travel a frame over the ground of ankles that truly stand."""
    stands = np.linalg.norm(np.diff(truth[:, ANKLES], axis=0), axis=-1) < 0.004
    return 1e3 * float(np.linalg.norm(np.diff(points[:, ANKLES, :2], axis=0), axis=-1)[stands].mean())


def test_jitter_and_sliding_go_and_the_posture_stays(truth: Array, mended: Mended) -> None:
    given, points = seen_by_network(truth), mended.motion.points
    assert jitter_mm(given) > 10.0 * jitter_mm(truth) and jitter_mm(points) < 1.5 * jitter_mm(truth)
    assert error_mm(points, truth) < 1.03 * error_mm(given, truth)
    assert slide_mm(given, truth) > 30.0 and slide_mm(points, truth) < 6.0
    assert mended.contacts and not mended.exchanged.any() and mended.notes == ()


def test_lengths_stay_and_the_feet_stand_on_zero(mended: Mended) -> None:
    motion = mended.motion
    lengths = np.linalg.norm(np.diff(motion.points[:, [HIPS[0], 9]], axis=1), axis=-1)
    assert np.ptp(lengths) < 1e-9
    height = -float(sole_offsets(motion.body)[..., 2].min())
    places = [contact.place[2] for contact in mended.contacts]
    assert abs(np.median(places) - height) < 0.03
    assert motion.method == "mend" and np.isnan(motion.point_covariance).all()


def test_exchanged_sides_are_found_and_put_right(truth: Array) -> None:
    given = seen_by_network(truth, 5)
    given[40:60] = given[40:60][:, OPPOSITE]
    assert np.flatnonzero(exchanged_frames(given)).tolist() == list(range(40, 60))
    found = run(mend_motion(given, RATE, MendOptions()))
    assert found.exchanged.sum() == 20 and "exchanged in 20 frames" in found.notes[0]
    assert error_mm(found.motion.points, truth) < 1.05 * error_mm(seen_by_network(truth, 5), truth)


def test_a_body_that_turns_is_not_exchanged(truth: Array) -> None:
    angles = np.linspace(0.0, 4.0 * np.pi, len(truth))
    turned = truth.copy()
    turned[..., 0] = np.cos(angles)[:, None] * truth[..., 0] - np.sin(angles)[:, None] * truth[..., 1]
    turned[..., 1] = np.sin(angles)[:, None] * truth[..., 0] + np.cos(angles)[:, None] * truth[..., 1]
    assert not exchanged_frames(seen_by_network(turned, 2)).any()


def test_posed_frames_stay_and_those_beside_them_follow(truth: Array) -> None:
    given = seen_by_network(truth)
    posed = (20, 45, 70)
    given[list(posed)] = truth[list(posed)]
    options = MendOptions(posed, plant_feet=False, floor=False)
    points = run(mend_motion(given, RATE, options)).motion.points
    plain = run(mend_motion(seen_by_network(truth), RATE, MendOptions(plant_feet=False, floor=False)))
    assert error_mm(points[list(posed)], truth[list(posed)]) < 20.0
    assert error_mm(points, truth) < 0.85 * error_mm(plain.motion.points, truth)
    assert jitter_mm(points) < 1.6 * jitter_mm(truth)


def test_a_way_that_is_not_in_the_file_is_found_by_the_feet(truth: Array) -> None:
    found = run(mend_motion(about_hips(seen_by_network(truth, place_m=0.0)), RATE, MendOptions()))
    way = [points[:, HIPS].mean(axis=1) for points in (found.motion.points, truth)]
    error = (way[0] - way[0].mean(axis=0)) - (way[1] - way[1].mean(axis=0))
    assert np.linalg.norm(error, axis=1).mean() < 0.2
    assert any("by the feet" in note for note in found.notes)


def test_the_hips_stay_where_a_frame_was_posed(truth: Array) -> None:
    hips = truth[:, HIPS].mean(axis=1)
    feet = truth[:, ANKLES] - hips[:, None]
    shaken = hips + np.random.default_rng(0).normal(0.0, 0.05, hips.shape)
    shaken[30] = hips[30]
    found = place_by_feet(shaken, feet, RATE, 0.1, np.array([30]))
    np.testing.assert_allclose(found[30], hips[30], atol=2e-3)
    assert np.linalg.norm(np.diff(found - hips, axis=0), axis=1).mean() < 0.004


def test_missing_and_repeated_frames_are_filled(truth: Array) -> None:
    given = seen_by_network(truth)
    given[10:14] = np.nan
    given[30] = given[29]
    found = run(mend_motion(given, RATE, MendOptions()))
    assert found.notes[0].startswith("5 frames") and np.isfinite(found.motion.points).all()
    assert error_mm(found.motion.points, truth) < 1.05 * error_mm(seen_by_network(truth), truth)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda points: points[:1], "1 frame; one of 3 to"),
        (lambda points: np.broadcast_to(points[0], (100_000, 13, 3)), "100000 frames; one of 3 to"),
        (lambda points: np.full_like(points, np.nan), "the whole body in 0 of"),
        (lambda points: 0.0 * points, "0 m long; a person's is"),
        (lambda points: 1e3 * points, "m long; a person's is"),
    ],
)
def test_what_cannot_be_mended_is_said_in_one_sentence(truth: Array, change: object, said: str) -> None:
    with pytest.raises(InputError, match=said):
        run(mend_motion(change(truth), RATE, MendOptions()))  # type: ignore[operator]


@pytest.mark.parametrize(
    ("posed", "said"),
    [
        ((90,), "posed frame 91 is not in the motion, whose frames are 1 to 90"),
        (tuple(range(88)), "2 of 90 frames show a body and are not posed; at least 3 must be so"),
    ],
)
def test_posed_frames_that_cannot_be_are_refused(truth: Array, posed: tuple[int, ...], said: str) -> None:
    with pytest.raises(InputError, match=said):
        run(mend_motion(truth, RATE, MendOptions(posed=posed)))


def test_an_actor_is_measured_by_its_points(truth: Array) -> None:
    own = stepping()[0].actor.segments_m
    found = measured_actor(truth).segments_m
    assert max(abs(found[name] - own[name]) for name in ("thigh.L", "shin.R", "forearm.L", "trunk")) < 0.02
