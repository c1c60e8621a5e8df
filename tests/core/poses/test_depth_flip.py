"""Flipped depth: the image stays, the side changes, lengths and joint limits hold."""

import numpy as np
import pytest
from _performances import (
    BODY,
    COLUMN,
    POINT,
    beyond_limits_rad,
    camera_around,
    camera_at,
    natural_posture,
    pixels,
    points,
    segment_lengths,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from keymark.core.arrays import Array
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.human import HUMAN, LIMBS, TRUNK
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.poses.depth_flip import flipped
from keymark.core.poses.limb_chain import DISTINCT_M, LimbChain

FRONT = camera_at(np.array([0.0, -4.0, 1.2]))
SEEDS = st.integers(0, 2**32 - 1)


def posed(**angles: float) -> Posture:
    """Standing before the camera, with some degrees of freedom set [rad]; names have _ for a dot."""
    vector = standing_posture(BODY).to_vector()
    for name, value in angles.items():
        vector[COLUMN[name.replace("__", ".")]] = value
    return Posture.from_vector(HUMAN, vector)


def depths(posture: Posture, camera: Camera, limb: str) -> Array:
    """(2,) how much farther the middle lies than the root, and the end than the middle [m]."""
    chain = LimbChain.of(BODY, limb)
    eye = camera.matrix_world[:3, 3]
    root, middle, end = points(posture)[chain.columns]
    # Along the lines of sight, which is what a flip changes.
    return np.array(
        [
            (middle - root) @ (middle - eye) / np.linalg.norm(middle - eye),
            (end - middle) @ (end - eye) / np.linalg.norm(end - eye),
        ]
    )


@settings(max_examples=30)
@given(SEEDS, st.sampled_from(LIMBS))
def test_a_flipped_limb_keeps_lengths_limits_and_the_rest_of_the_body(seed: int, limb: str) -> None:
    posture, camera = natural_posture(seed), camera_around(seed + 1)
    chain = LimbChain.of(BODY, limb)
    others = np.setdiff1d(np.arange(34), chain.dofs)
    before = depths(posture, camera, limb)
    for other in flipped(BODY, posture, camera, limb):
        np.testing.assert_allclose(segment_lengths(other), segment_lengths(posture), atol=1e-9)
        np.testing.assert_allclose(other.minus(posture)[others], 0.0, atol=1e-9)
        assert beyond_limits_rad(other).max() < 1e-9
        assert (np.sign(depths(other, camera, limb)) != np.sign(before)).any()


@settings(max_examples=30)
@given(SEEDS, st.sampled_from(LIMBS))
def test_a_flip_within_joint_limits_keeps_the_image(seed: int, limb: str) -> None:
    posture, camera = natural_posture(seed), camera_around(seed + 1)
    chain = LimbChain.of(BODY, limb)
    exact = [
        way for way in chain.ways_in_sight(posture, chain.sight_lines(posture, camera)) if way.off_m < 1e-9
    ]
    assert exact  # the posture itself is one of them
    for way in exact:
        np.testing.assert_allclose(pixels(way.posture, camera), pixels(posture, camera), atol=0.01)
        assert np.abs(chain.excess_rad(way.posture)).max() == 0.0


@settings(max_examples=30)
@given(SEEDS, st.sampled_from(LIMBS))
def test_flipping_the_same_part_again_comes_back(seed: int, limb: str) -> None:
    """Where nothing was in the way, to within what counts as the same place."""
    posture, camera = natural_posture(seed, 0.5), camera_around(seed + 1)
    for other in flipped(BODY, posture, camera, limb):
        kept = np.abs(pixels(other, camera) - pixels(posture, camera)).max() < 0.01
        apart = np.linalg.norm(points(other) - points(posture), axis=-1).max()
        if kept and apart > 3.0 * DISTINCT_M:
            ways = flipped(BODY, other, camera, limb)
            off = [np.linalg.norm(points(back) - points(posture), axis=-1).max() for back in ways]
            assert min(off) < 1.5 * DISTINCT_M


def test_an_arm_held_forward_is_flipped_back_and_stays_in_the_picture() -> None:
    posture = posed(shoulder__L__rotation_y=0.0, shoulder__L__rotation_z=-0.5, elbow__L__flexion=0.4)
    before = depths(posture, FRONT, "arm.L")
    ways = flipped(BODY, posture, FRONT, "arm.L")
    other = next(one for one in ways if depths(one, FRONT, "arm.L")[1] < 0.0)
    after = depths(other, FRONT, "arm.L")
    assert before[0] < -0.1 and after[0] == pytest.approx(-before[0], abs=0.02)
    assert before[1] < -0.1 and after[1] < -0.1
    np.testing.assert_allclose(pixels(other, FRONT), pixels(posture, FRONT), atol=0.5)


def test_a_knee_does_not_bend_backwards() -> None:
    posture = posed(hip__L__rotation_x=-1.2, knee__L__flexion=1.3)
    assert depths(posture, FRONT, "leg.L")[0] < -0.2
    for other in flipped(BODY, posture, FRONT, "leg.L"):
        assert beyond_limits_rad(other).max() < 1e-9


def test_a_limb_flat_in_the_picture_has_nothing_to_flip() -> None:
    far = camera_at(np.array([0.0, -400.0, 1.4]))
    assert flipped(BODY, Posture.rest(HUMAN), far, "arm.L") == ()


def test_a_trunk_that_leans_forward_leans_back() -> None:
    posture = posed(waist__rotation_x=0.35)
    first, *_ = flipped(BODY, posture, FRONT, TRUNK)
    before, after = points(posture), points(first)
    shoulders = [POINT["shoulder.L"], POINT["shoulder.R"]]
    lean, other = (each[shoulders].mean(axis=0)[1] - each[POINT["hip.L"]][1] for each in (before, after))
    assert lean < -0.07 and other > 0.07
    np.testing.assert_allclose(segment_lengths(first), segment_lengths(posture), atol=1e-9)
    feet = [POINT["ankle.L"], POINT["ankle.R"]]
    np.testing.assert_allclose(after[feet], before[feet], atol=0.01)
    seen = [POINT[name] for name in ("wrist.L", "wrist.R", "elbow.L", "elbow.R", "shoulder.L", "head")]
    np.testing.assert_allclose(pixels(first, FRONT)[seen], pixels(posture, FRONT)[seen], atol=4.0)


@pytest.mark.parametrize("seed", range(6))
def test_a_trunk_keeps_its_lengths_and_its_middle_in_the_picture(seed: int) -> None:
    posture, camera = natural_posture(seed, 0.4), camera_around(seed)
    joints = [HUMAN.joint_index("waist"), HUMAN.joint_index("neck")]
    waist = HUMAN.ball_dofs[HUMAN.ball_joints.index(joints[0])]
    middle = BODY.pose(posture).origin[joints]
    for other in flipped(BODY, posture, camera, TRUNK):
        np.testing.assert_allclose(segment_lengths(other), segment_lengths(posture), atol=1e-9)
        np.testing.assert_allclose(other.translation, posture.translation)
        now = BODY.pose(other).origin[joints]
        bend = other.to_vector()[waist]
        if not np.isclose(bend, HUMAN.limits[waist].T).any():
            np.testing.assert_allclose(camera.project(now)[0], camera.project(middle)[0], atol=3.0)
        assert np.linalg.norm(now - middle, axis=-1).max() > 0.02
        assert beyond_limits_rad(other)[waist].max() < 1e-9


def test_an_unknown_part_is_refused() -> None:
    with pytest.raises(KeyError):
        flipped(BODY, posed(), FRONT, "tail")
