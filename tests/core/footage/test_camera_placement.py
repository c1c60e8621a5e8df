"""Height, tilt and roll of a camera, as numbers and in its pose."""

import numpy as np
import pytest
from keymark.core.footage.camera import Camera
from keymark.core.footage.camera_fields import CameraPlacement, heading_rad


@pytest.mark.parametrize("seed", range(8))
def test_numbers_and_pose_say_the_same(seed: int) -> None:
    rng = np.random.default_rng(seed)
    height, tilt, roll = rng.uniform(0.2, 4.0), rng.uniform(-1.4, 1.4), rng.uniform(-3.0, 3.0)
    heading, place = rng.uniform(-3.0, 3.0), tuple(rng.normal(0.0, 3.0, 2))
    pose = CameraPlacement(height, tilt, roll).matrix(place, heading)
    read = CameraPlacement.of(pose)
    assert (read.height_m, read.tilt_rad, read.roll_rad) == pytest.approx((height, tilt, roll))
    assert heading_rad(pose) == pytest.approx(heading)
    assert np.allclose(pose[:3, :3].T @ pose[:3, :3], np.eye(3)) and np.linalg.det(pose) > 0.0
    again = CameraPlacement(1.0, 0.1, 0.2).applied_to(pose)
    assert np.allclose(again[:2, 3], place) and heading_rad(again) == pytest.approx(heading)


def test_a_level_camera_looks_ahead_and_a_negative_tilt_down() -> None:
    """Along +Y; a point at the camera's own height is in the middle only where it is level."""
    camera = Camera(36.0, 36.0, (200, 100), CameraPlacement(1.5, 0.0, 0.0).matrix())
    middle, depth = camera.project([0.0, 5.0, 1.5])
    assert middle == pytest.approx((100.0, 50.0)) and depth == pytest.approx(5.0)
    down = Camera(36.0, 36.0, (200, 100), CameraPlacement(1.5, -0.2, 0.0).matrix())
    assert down.project([0.0, 5.0, 1.5])[0][1] < 50.0
    rolled = Camera(36.0, 36.0, (200, 100), CameraPlacement(1.5, 0.0, 0.1).matrix())
    foot, head = rolled.project([[0.0, 5.0, 0.5], [0.0, 5.0, 2.5]])[0]
    assert head[0] > foot[0]  # the picture leans clockwise


@pytest.mark.parametrize("tilt", [-np.pi / 2, np.pi / 2])
def test_a_camera_that_looks_straight_down_or_up_has_a_heading_and_no_roll(tilt: float) -> None:
    pose = CameraPlacement(2.0, tilt, 0.0).matrix((0.0, 0.0), 0.7)
    assert CameraPlacement.of(pose).tilt_rad == pytest.approx(tilt)
    assert CameraPlacement.of(pose).roll_rad == 0.0
    assert np.allclose(CameraPlacement.of(pose).applied_to(pose), pose, atol=1e-9)
