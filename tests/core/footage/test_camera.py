"""The camera's projection, its Jacobian, its rays, and its reading from a take."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.errors import InputError
from keymark.core.footage.camera import Camera
from keymark.core.footage.camera_fields import CameraPlacement

DISTORTIONS = [(0.0, 0.0, 0.0), (-0.12, 0.03, -0.004), (0.2, 0.05, 0.01)]


def turned(angle: float, location: tuple[float, float, float] = (0.0, -4.0, 1.0)) -> np.ndarray:
    """A camera at `location` that looks along +Y, turned by `angle` about the vertical."""
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.eye(4)
    upright = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    matrix[:3, :3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ upright
    matrix[:3, 3] = location
    return matrix


def fields(**changes: Any) -> dict[str, Any]:
    """A valid camera as a take holds it, with changes; None takes a field away."""
    good = {"lens_mm": 40.0, "sensor_width_mm": 36.0, "resolution": [320, 240]}
    good["matrix_world"] = turned(0.3).tolist()
    return {name: value for name, value in {**good, **changes}.items() if value is not None}


def test_projection_agrees_with_a_computation_by_hand() -> None:
    camera = Camera(40.0, 36.0, (320, 240), turned(0.0))
    pixel, depth = camera.project([0.5, 0.0, 1.25])
    np.testing.assert_allclose(pixel, [160 + 320 * 40 / 36 * 0.5 / 4, 120 - 320 * 40 / 36 * 0.25 / 4])
    assert depth == pytest.approx(4.0)


def test_a_shift_to_the_right_and_up_moves_the_picture_left_and_down_in_image_widths() -> None:
    point = [0.2, 0.0, 1.1]
    straight = Camera(40.0, 36.0, (320, 240), turned(0.0)).project(point)[0]
    shifted = Camera(40.0, 36.0, (320, 240), turned(0.0), 0.1, 0.05).project(point)[0]
    np.testing.assert_allclose(shifted - straight, [-32.0, 16.0])


def test_distortion_scales_normalized_coordinates_by_its_polynomial() -> None:
    camera = Camera(36.0, 36.0, (100, 100), turned(0.0, (0.0, -1.0, 0.0)), distortion=(0.1, -0.02, 0.003))
    factor = 1 + 0.1 * 0.3125 - 0.02 * 0.3125**2 + 0.003 * 0.3125**3
    np.testing.assert_allclose(camera.project([0.5, 0.0, 0.25])[0], [50 + 50 * factor, 50 - 25 * factor])


def test_points_behind_the_camera_have_no_pixel_but_a_negative_depth() -> None:
    camera = Camera(40.0, 36.0, (320, 240), turned(0.0))
    pixel, depth = camera.project([[0.0, -5.0, 1.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(depth, [-1.0, 4.0])
    assert np.isnan(pixel[0]).all() and np.isfinite(pixel[1]).all()
    assert np.isnan(camera.project_jacobian([0.0, -5.0, 1.0])).any()


@pytest.mark.parametrize("distortion", DISTORTIONS)
def test_jacobians_agree_with_central_differences(distortion: tuple[float, float, float]) -> None:
    camera = Camera(35.0, 32.0, (640, 360), turned(0.4), 0.05, -0.03, distortion)
    points = np.random.default_rng(5).uniform(-0.8, 0.8, (20, 3)) + [-0.5, 0.0, 1.0]
    step = 1e-6
    shift = step * np.eye(3)[:, None]
    pixels = (camera.project(points + shift)[0] - camera.project(points - shift)[0]) / (2 * step)
    depth = (camera.depth(points + shift) - camera.depth(points - shift)) / (2 * step)
    expected = np.moveaxis(pixels, 0, -1)  # (20, 2, 3)
    np.testing.assert_allclose(camera.project_jacobian(points), expected, rtol=1e-6, atol=1e-5)
    np.testing.assert_allclose(camera.depth_jacobian(points), depth.T, atol=1e-8)


@pytest.mark.parametrize("distortion", DISTORTIONS)
def test_rays_lead_back_through_the_pixels_they_came_from(distortion: tuple[float, float, float]) -> None:
    camera = Camera(30.0, 36.0, (640, 480), turned(-0.7), 0.02, 0.04, distortion)
    pixels = np.stack(np.meshgrid(np.linspace(0, 640, 9), np.linspace(0, 480, 7)), axis=-1)
    origin, direction = camera.rays(pixels)
    np.testing.assert_allclose(np.linalg.norm(direction, axis=-1), 1.0)
    np.testing.assert_allclose(camera.project(origin + 2.0 * direction)[0], pixels, atol=1e-7)


def test_a_pixel_that_no_light_reaches_has_no_ray() -> None:
    camera = Camera(36.0, 36.0, (100, 100), turned(0.0), distortion=(-1.0, 0.0, 0.0))
    assert np.isnan(camera.rays([99.0, 50.0])[1]).all()
    assert np.isfinite(camera.rays([60.0, 50.0])[1]).all()


def test_a_moving_camera_sees_each_point_from_its_own_frame() -> None:
    matrices = np.stack([turned(angle, (angle, -4.0, 1.0)) for angle in (0.0, 0.1, 0.2)])
    moving = Camera(40.0, 36.0, (320, 240), matrices)
    points = np.random.default_rng(1).uniform(-0.5, 0.5, (3, 4, 3)) + [0.0, 0.0, 1.0]
    frame = np.arange(3)[:, None]
    for index, matrix in enumerate(matrices):
        fixed = Camera(40.0, 36.0, (320, 240), matrix)
        np.testing.assert_allclose(moving.project(points, frame)[0][index], fixed.project(points[index])[0])
        jacobian = moving.project_jacobian(points, frame)[index]
        np.testing.assert_allclose(jacobian, fixed.project_jacobian(points[index]))
        np.testing.assert_allclose(
            moving.depth_jacobian(points, frame)[index], fixed.depth_jacobian(points[index])
        )
    with pytest.raises(ValueError, match="frame"):
        moving.project(points)


@given(st.floats(-3.0, 3.0), st.floats(0.1, 10.0), st.floats(-0.3, 0.3))
def test_a_camera_survives_its_own_fields(angle: float, scale: float, shift: float) -> None:
    """Writing and reading gives the same camera; a scaled matrix gives the same view as the plain one."""
    matrix = turned(angle)
    matrix[:3, :3] *= scale
    read = Camera.from_dict(fields(matrix_world=matrix.tolist(), shift_x=shift, distortion=[0.1, 0.2]))
    assert read.distortion == (0.1, 0.2, 0.0)
    np.testing.assert_allclose(read.matrix_world, turned(angle), atol=1e-12)
    again = Camera.from_dict(read.to_dict())
    np.testing.assert_allclose(again.matrix_world, read.matrix_world, atol=1e-15)
    assert (again.lens_mm, again.shift_x, again.distortion) == (read.lens_mm, read.shift_x, read.distortion)


def test_poses_a_frame_are_read_and_written() -> None:
    poses = [turned(0.0).tolist(), turned(0.2).tolist()]
    camera = Camera.from_dict(fields(matrix_world_frames=poses, matrix_world=None))
    assert camera.is_moving
    np.testing.assert_allclose(camera.to_dict()["matrix_world_frames"], poses, atol=1e-12)


def sheared() -> list[list[float]]:
    matrix = turned(0.0)
    matrix[0, 1] += 0.2
    return matrix.tolist()


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"lens_mm": 0}, "lens_mm"),
        ({"lens_mm": "40"}, "lens_mm"),
        ({"lens_mm": None}, "lens_mm is missing"),
        ({"sensor_width_mm": float("nan")}, "sensor_width_mm"),
        ({"shift_x": float("inf")}, "shift_x"),
        ({"shift_y": True}, "shift_y"),
        ({"resolution": [320]}, "resolution"),
        ({"resolution": [320, 0]}, "resolution"),
        ({"resolution": [320.5, 240]}, "resolution"),
        ({"distortion": [0.1, 0.2, 0.3, 0.4]}, "distortion"),
        ({"distortion": {"k1": 0.1, "p1": 0.2}}, "distortion"),
        ({"matrix_world": None}, "matrix_world is missing"),
        ({"matrix_world": [[1, 0], [0, 1]]}, "matrix_world"),
        ({"matrix_world": [[1, 0, 0, 0], [0, 1, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}, "matrix_world"),
        ({"matrix_world": np.zeros((4, 4)).tolist()}, "matrix_world"),
        ({"matrix_world": np.diag([1, 1, -1, 1]).tolist()}, "determinant"),
        ({"matrix_world": sheared()}, "sheared"),
        ({"matrix_world": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]}, "last row"),
        ({"matrix_world_frames": []}, "matrix_world_frames"),
        ({"matrix_world_frames": [np.eye(4).tolist(), sheared()]}, r"matrix_world_frames\[1\]"),
    ],
)
def test_each_unusable_field_is_named_in_one_sentence(changes: dict[str, Any], word: str) -> None:
    with pytest.raises(InputError, match=f"take.json: camera.*{word}.*(must|its axes)") as caught:
        Camera.from_dict(fields(**changes), "take.json: camera")
    assert "\n" not in str(caught.value)


PLACED = {"lens_mm": 35.0, "sensor_width_mm": 36.0, "resolution": [200, 100], "height_m": 1.5}


def test_height_tilt_and_roll_do_instead_of_a_matrix() -> None:
    above = Camera.from_dict(PLACED)
    assert above.matrix_world[:3, 3] == pytest.approx((0.0, 0.0, 1.5))
    tilted = Camera.from_dict({**PLACED, "tilt_deg": -10.0, "roll_deg": 5.0, "distance_m": 4.0})
    placement = CameraPlacement.of(tilted.matrix_world)
    assert np.degrees(placement.tilt_rad) == pytest.approx(-10.0)
    assert np.degrees(placement.roll_rad) == pytest.approx(5.0)
    assert tilted.matrix_world[:3, 3] == pytest.approx((0.0, -4.0, 1.5))
    assert np.allclose(Camera.from_dict(tilted.to_dict()).matrix_world, tilted.matrix_world)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"height_m": 0}, r"camera: height_m is 0; it must be a number from 0\.01 to 1000 m"),
        ({"tilt_deg": 91}, "camera: tilt_deg is 91; it must be a number from -90 to 90 degrees"),
        ({"roll_deg": "5"}, "camera: roll_deg is '5'"),
        ({"distance_m": -1}, "camera: distance_m is -1"),
        ({"height_m": None, "tilt_deg": 3}, "camera: height_m is null; it must be a number"),
        ({"height_m": None}, "camera: matrix_world is missing; .* height_m and tilt_deg do as well"),
        (
            {"matrix_world": np.eye(4).tolist()},
            "camera: there are both height_m and matrix_world; give height_m",
        ),
    ],
)
def test_a_wrong_placement_is_refused_in_a_sentence(change: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        Camera.from_dict({**PLACED, **change})
