"""The camera that is assumed before anybody has said what the footage was taken with."""

import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.footage.camera import Camera, default_camera_pose, guess_lens

SIZES = [(1080, 1920), (2160, 3840), (640, 480), (320, 240), (1920, 1080), (1440, 1080), (720, 720)]


def test_a_phone_held_upright_sees_as_much_as_its_photographs_less_what_steadies() -> None:
    guess = guess_lens((1080, 1920))
    assert "phone" in guess.reason
    long_side_view = np.degrees(2.0 * np.arctan(18.0 / guess.lens_mm))
    photograph_view = np.degrees(2.0 * np.arctan(0.8 * 43.267 / 2.0 / 26.0))
    assert 60.0 < long_side_view < photograph_view
    assert guess.sensor_width_mm == pytest.approx(36.0 * 9.0 / 16.0)


def test_a_webcams_height_is_that_of_its_wide_picture() -> None:
    """Its picture of 4 to 3 is cut from one of 16 to 9 with a diagonal view of 68 degrees."""
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
    """Half the resolution is the same camera, but that small pictures of 4 to 3 are webcams'."""
    half = (size[0] // 2, size[1] // 2)
    if size != (1440, 1080):
        assert guess_lens(half) == guess_lens(size)


@pytest.mark.parametrize("size", SIZES)
def test_the_performer_is_in_view_from_the_first_stand(size: tuple[int, int]) -> None:
    """Feet on the floor at the origin, arms stretched sideways: all in the picture, and not tiny."""
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
