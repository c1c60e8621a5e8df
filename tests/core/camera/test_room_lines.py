"""The straight edges of a room tell the camera's tilt, roll and lens; other pictures tell nothing."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from keymark.core.arrays import Image
from keymark.core.camera.camera import Camera
from keymark.core.camera.camera_evidence import CameraEvidence, Uprights
from keymark.core.camera.camera_fields import CameraPlacement
from keymark.core.camera.camera_fit import HEIGHT, fit_camera
from keymark.core.camera.room_lines import find_room, find_segments, room_of

SIZE = (640, 480)
EYE = 1.4


def camera_at(tilt: float, roll: float, lens_mm: float, heading: float = 0.5) -> Camera:
    """A camera in the middle of the room; degrees, and its heading in radians."""
    placement = CameraPlacement(EYE, np.radians(tilt), np.radians(roll))
    return Camera(lens_mm, 36.0, SIZE, placement.matrix((0.0, 0.0), heading))


def room(camera: Camera, walls: bool = True) -> Image:
    """Edges of a room 6 m wide and long, with doors and boards; without walls its plumb edges alone."""
    corners = 3.0 * np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    edges = []
    for first, second in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        for share in np.linspace(0.0, 0.9, 10):
            place = first + share * (second - first)
            edges.append([[*place, 0.0], [*place, 2.0 + share]])
        if walls:
            edges += [[[*first, z], [*second, z]] for z in (0.0, 0.1, 0.9, 2.1, 2.6)]
    picture = np.full((*SIZE[::-1], 3), 128, dtype=np.uint8)
    for edge in np.array(edges):
        for piece in np.linspace(edge[0], edge[1], 40, axis=0).repeat(2, axis=0)[1:-1].reshape(-1, 2, 3):
            if (camera.depth(piece) > 0.2).all():
                ends = [tuple(int(round(16.0 * value)) for value in end) for end in camera.project(piece)[0]]
                cv2.line(picture, ends[0], ends[1], (230, 230, 230), 2, cv2.LINE_AA, 4)
    noise = np.random.default_rng(4).normal(0.0, 4.0, picture.shape)
    return np.clip(picture + noise, 0, 255).astype(np.uint8)


@pytest.mark.parametrize(
    ("tilt", "roll", "lens_mm"),
    [(-6.0, 0.0, 35.0), (-23.0, -2.0, 36.0), (8.0, 1.5, 30.0), (-18.0, 13.0, 45.0)],
)
def test_a_room_tells_tilt_roll_and_lens(tilt: float, roll: float, lens_mm: float) -> None:
    true = camera_at(tilt, roll, lens_mm)
    found = find_room(room(true), 1.0, replace(true, lens_mm=40.0))
    assert found is not None and found.share > 0.9
    assert np.degrees([found.tilt_rad, found.roll_rad]) == pytest.approx([tilt, roll], abs=0.6)
    assert found.focal_px == pytest.approx(true.focal_px, rel=0.04)
    assert (np.sqrt(np.diagonal(found.covariance)) < [np.radians(1.0), np.radians(0.6), 0.08]).all()


def test_a_smaller_picture_tells_the_same() -> None:
    true = camera_at(-12.0, 3.0, 35.0)
    small = cv2.resize(room(true), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    found = find_room(np.asarray(small, dtype=np.uint8), 2.0, true)
    assert found is not None
    assert np.degrees([found.tilt_rad, found.roll_rad]) == pytest.approx([-12.0, 3.0], abs=0.8)


def test_plumb_edges_alone_leave_the_lens_open() -> None:
    true = camera_at(-15.0, 2.0, 35.0)
    found = find_room(room(true, walls=False), 1.0, true)
    assert found is not None
    assert np.degrees([found.tilt_rad, found.roll_rad]) == pytest.approx([-15.0, 2.0], abs=1.5)
    assert np.sqrt(found.covariance[2, 2]) > 0.15


def clutter() -> Image:
    random = np.random.default_rng(1)
    picture = np.full((*SIZE[::-1], 3), 128, dtype=np.uint8)
    for middle, angle in zip(random.uniform(40, 440, (90, 2)), random.uniform(0, np.pi, 90), strict=True):
        along = 30.0 * np.array([np.cos(angle), np.sin(angle)])
        first, second = ((middle + sign * along).astype(int) for sign in (1, -1))
        cv2.line(picture, tuple(map(int, first)), tuple(map(int, second)), (230, 230, 230), 2, cv2.LINE_AA)
    return picture


@pytest.mark.parametrize("picture", [clutter(), np.full((480, 640, 3), 90, dtype=np.uint8)])
def test_edges_that_run_anywhere_and_empty_pictures_tell_nothing(picture: Image) -> None:
    assert find_room(picture, 1.0, camera_at(0.0, 0.0, 35.0)) is None


def test_the_plumb_direction_is_none_that_a_camera_on_its_side_would_see() -> None:
    ends = [
        *((32, 15, 39, 203), (264, 184, 123, 191), (122, 201, 248, 194), (36, 181, 32, 64)),
        *((398, 186, 479, 181), (479, 173, 399, 178), (317, 168, 397, 165), (37, 18, 113, 21)),
        *((38, 37, 113, 40), (39, 57, 113, 58), (40, 76, 114, 77), (42, 133, 115, 131)),
    ]  # of a rendered room, whose camera is tilted by -4.5 degrees
    view = room_of(np.array(ends, dtype=float).reshape(-1, 2, 2), Camera(35.0, 36.0, (480, 270), np.eye(4)))
    assert view is not None
    assert np.degrees([view.tilt_rad, view.roll_rad]) == pytest.approx([-4.5, 0.0], abs=3.0)


def test_segments_are_where_they_are_drawn() -> None:
    picture = np.zeros((480, 640, 3), dtype=np.uint8)
    picture[:, 200:] = 200
    (first, *_) = find_segments(picture)
    assert first[:, 0] == pytest.approx([200.0, 200.0], abs=0.6) and np.ptp(first[:, 1]) > 400


def test_one_upright_in_a_room_tells_the_height() -> None:
    true = camera_at(-10.0, 4.0, 35.0)
    view = find_room(room(true), 1.0, true)
    put = replace(camera_at(0.0, 0.0, 40.0), matrix_world=CameraPlacement(1.0, 0.0, 0.0).matrix())
    foot = np.array([[-1.0, 2.2, 0.0]])
    ends = [true.project(foot + [0.0, 0.0, rise])[0] for rise in (0.0, 1.7)]
    one = Uprights.persons(*ends, 1.7)
    fit = fit_camera(put, CameraEvidence(uprights=one, room=view))
    assert fit.kept == ()
    assert fit.placement.height_m == pytest.approx(EYE, abs=0.08)
    assert HEIGHT in fit_camera(put, CameraEvidence(uprights=one)).kept
    assert fit_camera(put, CameraEvidence(room=view)).kept == (HEIGHT,)
