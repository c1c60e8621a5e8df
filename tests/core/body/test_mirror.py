"""Left and right exchanged."""

import numpy as np
import pytest
from _libraries import random_posture
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import sole_places
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.mirror import MIRROR, mirrored, mirrored_actor, other_side
from keymark.core.body.posture import Posture


@given(st.integers(0, 2**32 - 1))
def test_mirroring_twice_gives_the_very_same_numbers(seed: int) -> None:
    posture = Posture.stack([random_posture(seed, 1.2), random_posture(seed + 1)])
    twice = mirrored(mirrored(posture))
    np.testing.assert_array_equal(twice.translation, posture.translation)
    np.testing.assert_array_equal(twice.rotations, posture.rotations)
    np.testing.assert_array_equal(twice.angles, posture.angles)
    assert np.abs(mirrored(posture).to_vector() - posture.to_vector()).max() > 0.1


@pytest.mark.parametrize("seed", range(5))
def test_points_are_mirrored(seed: int) -> None:
    lengths = dict(Actor.from_stature(1.75).segments_m) | {"thigh.L": 0.5, "upper_arm.R": 0.25}
    body, opposite = Body(Actor(lengths)), Body(mirrored_actor(Actor(lengths)))
    posture = random_posture(seed, 0.8)
    pose, mirror_pose = body.pose(posture), opposite.pose(mirrored(posture))
    names = HUMAN.point_names
    swapped = [names.index(other_side(name)) for name in names]
    np.testing.assert_allclose(opposite.points(mirror_pose), body.points(pose)[swapped] * MIRROR, atol=1e-12)
    soles = sole_places(body, pose)[::-1] * MIRROR
    np.testing.assert_allclose(sole_places(opposite, mirror_pose), soles, atol=1e-12)
    for name in ("hand.L", "foot.R"):
        ends, others = opposite.segment_ends(mirror_pose, name), body.segment_ends(pose, other_side(name))
        np.testing.assert_allclose(np.stack(ends), np.stack(others) * MIRROR, atol=1e-12)


def test_what_looks_ahead_still_does() -> None:
    vector = np.zeros(34)
    for name, value in {"knee.L.flexion": 0.7, "pelvis.rotation_z": 0.3, "forearm.L.pronation": 0.2}.items():
        vector[HUMAN.dof_names.index(name)] = value
    other = dict(zip(HUMAN.dof_names, mirrored(Posture.from_vector(HUMAN, vector)).to_vector(), strict=True))
    assert other["knee.R.flexion"] == pytest.approx(0.7) and other["knee.L.flexion"] == 0.0
    assert other["pelvis.rotation_z"] == pytest.approx(-0.3)
    assert abs(other["forearm.R.pronation"]) == pytest.approx(0.2)
