"""Height, tilt and roll of a camera, the camera that is assumed at first, and the floor it sees."""

import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.footage.camera import Camera, default_camera_pose, guess_lens
from keymark.core.footage.camera_evidence import floor_grid
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
    assert "phone" in guess.reason
    long_side_view = np.degrees(2.0 * np.arctan(18.0 / guess.lens_mm))
    photograph_view = np.degrees(2.0 * np.arctan(0.8 * 43.267 / 2.0 / 26.0))
    assert 60.0 < long_side_view < photograph_view
    assert guess.sensor_width_mm == pytest.approx(36.0 * 9.0 / 16.0)


def test_a_webcams_height_is_that_of_its_wide_picture() -> None:
    guess = guess_lens((640, 480))
    assert "webcam" in guess.reason
    focal_px = guess.lens_mm / guess.sensor_width_mm * 640
    wide_diagonal_px = np.hypot(480 * 16 / 9, 480)
    assert np.degrees(2 * np.arctan(wide_diagonal_px / 2 / focal_px)) == pytest.approx(68.0, abs=0.2)


@pytest.mark.parametrize("size", [(1920, 1080), (3840, 2160), (1280, 720), (1440, 1080), (720, 720)])
def test_anything_else_is_a_usual_zoom(size: tuple[int, int]) -> None:
    guess = guess_lens(size)
    assert (guess.lens_mm, guess.sensor_width_mm) == (35.0, 36.0)


@pytest.mark.parametrize("size", SIZES)
def test_the_guess_depends_on_the_shape_and_not_on_the_fineness(size: tuple[int, int]) -> None:
    half = (size[0] // 2, size[1] // 2)
    if size != (1440, 1080):
        assert guess_lens(half) == guess_lens(size)


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
