"""The camera: projection, rays, fields of a take, where it stands, and the floor it sees."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera, default_camera_pose, guess_lens
from keymark.core.camera.camera_evidence import floor_grid
from keymark.core.camera.camera_fields import MOST_DISTORTION, CameraPlacement, heading_rad
from keymark.core.errors import InputError

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


@given(st.floats(-3.0, 3.0), st.floats(0.1, 10.0), st.floats(-0.3, 0.3))
def test_a_camera_survives_its_own_fields(angle: float, scale: float, shift: float) -> None:
    """Writing and reading gives the same camera; a scaled matrix gives the same view as the plain one."""
    matrix = turned(angle)
    matrix[:3, :3] *= scale
    distortion = [0.1, -MOST_DISTORTION]
    read = Camera.from_dict(fields(matrix_world=matrix.tolist(), shift_x=shift, distortion=distortion))
    assert read.distortion == (*distortion, 0.0)
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


SIZES = [(1080, 1920), (2160, 3840), (640, 480), (320, 240), (1920, 1080), (1440, 1080), (720, 720)]


def test_a_phone_held_upright_sees_as_much_as_its_photographs_less_what_steadies() -> None:
    guess = guess_lens((1080, 1920))
    assert "phone" in guess.source
    long_side_view = np.degrees(2.0 * np.arctan(18.0 / guess.lens_mm))
    photograph_view = np.degrees(2.0 * np.arctan(0.8 * 43.267 / 2.0 / 26.0))
    assert 60.0 < long_side_view < photograph_view
    assert guess.sensor_width_mm == pytest.approx(36.0 * 9.0 / 16.0)


def test_a_webcams_height_is_that_of_its_wide_picture() -> None:
    guess = guess_lens((640, 480))
    assert "webcam" in guess.source
    focal_px = guess.lens_mm / guess.sensor_width_mm * 640
    wide_diagonal_px = np.hypot(480 * 16 / 9, 480)
    assert np.degrees(2 * np.arctan(wide_diagonal_px / 2 / focal_px)) == pytest.approx(68.0, abs=0.2)


@pytest.mark.parametrize("size", [(1920, 1080), (3840, 2160), (1280, 720), (1440, 1080), (720, 720)])
def test_anything_else_is_a_usual_zoom(size: tuple[int, int]) -> None:
    guess = guess_lens(size)
    assert (guess.lens_mm, guess.sensor_width_mm) == (35.0, 36.0)


@pytest.mark.parametrize("size", SIZES)
def test_the_performer_is_in_view_from_the_first_stand(size: tuple[int, int]) -> None:
    guess = guess_lens(size)
    stand = default_camera_pose(guess.lens_mm, guess.sensor_width_mm, size)
    camera = Camera(guess.lens_mm, guess.sensor_width_mm, size, stand)
    body = Body(Actor.from_stature(1.85))
    points = body.points(body.pose(Posture.rest(HUMAN)))
    points[:, 2] -= points[:, 2].min()
    pixels, depth = camera.project(np.concatenate([points, [[0.0, 0.0, 0.0]]]))
    assert (depth > 0.0).all()
    assert (pixels > 0.0).all() and (pixels < size).all()
    spans = (pixels.max(axis=0) - pixels.min(axis=0)) / size
    assert spans.max() > 0.4
    assert camera.project(np.array([0.0, 0.0, 1.4]))[0] == pytest.approx(np.array(size) / 2)


SIZE = (640, 480)


def camera(tilt: float, height_m: float = 1.5) -> Camera:
    return Camera(
        35.0, 36.0, SIZE, CameraPlacement(height_m, float(np.radians(tilt)), 0.0).matrix((0.3, 0.4))
    )


@pytest.mark.parametrize("tilt", [-60.0, -10.0, 0.0, 10.0])
def test_every_piece_lies_on_a_whole_meter_of_the_floor(tilt: float) -> None:
    seen = camera(tilt)
    grid = floor_grid(seen)
    assert len(grid.lines) > 20
    location, sight = seen.rays(grid.lines)
    floor = location + (-location[2] / sight[..., 2])[..., None] * sight
    off = np.abs(floor[..., :2] - np.round(floor[..., :2])).max(axis=1)
    assert off.min(axis=1).max() < 1e-6
    assert np.allclose(grid.depth_m, seen.depth(floor).min(axis=1))
    onward = floor[:, 1, :2] - floor[:, 0, :2]
    assert onward.min() > -1e-6 and (np.diff(floor[onward[:, 1] > 0.1, 0, 0]) > -1e-6).all()
    beside = np.abs(grid.lines - np.array(SIZE) / 2.0) / SIZE
    assert beside.max() <= 0.6 + 1e-9


def test_the_horizon_is_where_the_view_is_level() -> None:
    assert floor_grid(camera(0.0)).horizon[..., 1] == pytest.approx(240.0, abs=0.02)
    assert (floor_grid(camera(-10.0)).horizon[..., 1] < 150.0).all()
    assert len(floor_grid(camera(-60.0)).horizon) == 0


def test_a_camera_that_moves_sees_the_floor_from_each_pose() -> None:
    poses = np.stack([camera(0.0).matrix_world, camera(-20.0).matrix_world])
    moving = Camera(35.0, 36.0, SIZE, poses)
    assert np.allclose(floor_grid(moving, 1).lines, floor_grid(camera(-20.0)).lines)
