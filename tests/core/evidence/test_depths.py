"""Depths of the principal points as an observation."""

import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.evidence import keypoints as depths
from keymark.core.footage.camera import Camera

BODY = Body(Actor.from_stature(1.75))


def camera_in_front(poses: int | None = None) -> Camera:
    """A camera 4 m before the performer, looking along +Y; one that backs away by 1 m a frame if asked."""
    matrix = np.array([[1.0, 0, 0, 0], [0, 0, -1, -4], [0, 1, 0, 0], [0, 0, 0, 1]])
    if poses is not None:
        matrix = np.tile(matrix, (poses, 1, 1))
        matrix[:, 1, 3] -= np.arange(poses)
    return Camera(40.0, 36.0, (320, 240), matrix)


def test_the_rest_posture_stands_at_the_cameras_distance() -> None:
    """At rest every principal point lies in the plane of the hips, 4 m away."""
    pose = BODY.pose(Posture.rest(HUMAN))
    np.testing.assert_allclose(depths.evaluate(BODY, camera_in_front(), pose), 4.0, atol=1e-12)


def test_a_moving_camera_is_taken_at_its_frame() -> None:
    pose = BODY.pose(Posture.rest(HUMAN, (3,)))
    depth = depths.evaluate(BODY, camera_in_front(3), pose, np.arange(3))
    np.testing.assert_allclose(depth, np.broadcast_to(np.array([[4.0], [5.0], [6.0]]), (3, 13)), atol=1e-12)


def test_the_papers_variance_is_kept_in_meters() -> None:
    """10⁵ mm² are 0.1 m²."""
    assert depths.DEPTH_VARIANCE_M2 == pytest.approx(1e5 * 1e-6)


@pytest.mark.parametrize("seed", range(10))
def test_the_jacobian_agrees_with_central_differences_on_the_manifold(seed: int) -> None:
    """Steps are taken by `plus` at random postures, seen by a moving camera."""
    rng = np.random.default_rng(seed)
    posture = Posture.rest(HUMAN).plus(rng.normal(0.0, 0.6, HUMAN.dof_count))
    camera, frame, step = camera_in_front(2), 1, 1e-6
    shifted = [
        depths.evaluate(
            BODY, camera, BODY.pose(posture.plus(sign * step * np.eye(HUMAN.dof_count))), np.full(34, 1)
        )
        for sign in (1.0, -1.0)
    ]
    numeric = (shifted[0] - shifted[1]).T / (2.0 * step)
    np.testing.assert_allclose(depths.jacobian(BODY, camera, BODY.pose(posture), frame), numeric, atol=1e-8)
