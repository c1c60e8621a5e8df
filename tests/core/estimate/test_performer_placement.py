"""Placing a standing body before the camera."""

from dataclasses import replace

import numpy as np
import pytest
from _scene import BODY, CAMERA, SEGMENTS, film
from keymark.core.body.body_volume import hip_height_m, standing_height_m, standing_posture
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.errors import InputError
from keymark.core.estimate.performer_placement import ground_place, place_standing
from keymark.core.markers.region_tracks import RegionTracks


def looking_down(angle_rad: float, place: tuple[float, float, float]) -> Camera:
    """A camera that looks along +Y and down."""
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[1.0, 0.0, 0.0], [0.0, s, -c], [0.0, c, s]])
    matrix[:3, 3] = place
    return Camera(40.0, 36.0, (320, 240), matrix)


def seen(posture: Posture) -> RegionTracks:
    return film(Posture.stack([posture]))


def soles_m(posture: Posture) -> float:
    return float(posture.translation[2]) - hip_height_m(BODY)


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (0.8, 0.6, 0.0), (-0.9, -0.5, 0.0)])
def test_a_body_stands_where_its_regions_are(place: tuple[float, float, float]) -> None:
    true = standing_posture(BODY, np.array(place))
    found = place_standing(BODY, CAMERA, 0, seen(true), SEGMENTS)
    assert np.linalg.norm(found.translation - true.translation) < 0.05


def test_regions_larger_than_any_body_leave_it_in_sight() -> None:
    tracks = seen(standing_posture(BODY))
    for factor in (1e2, 1e4, 1e6):
        found = place_standing(BODY, CAMERA, 0, replace(tracks, area=factor * tracks.area), SEGMENTS)
        assert np.isfinite(found.translation).all() and CAMERA.depth(found.translation) > 0.0


def test_the_floor_helps_where_the_camera_looks_down_on_it() -> None:
    camera = looking_down(0.5, (0.0, -3.5, 2.9))
    true = standing_posture(BODY)
    near = standing_posture(BODY, np.array([0.0, -0.35, 0.2]))  # what the same body too near looks like
    from keymark.core.terms.region_model import MarkerPlacement, RegionModel

    model = RegionModel(BODY, camera, tuple(MarkerPlacement.usual(name) for name in SEGMENTS))
    found = place_standing(BODY, camera, 0, film(Posture.stack([near]), model=model), SEGMENTS)
    assert abs(soles_m(found)) < 0.05
    error = np.linalg.norm(found.translation - true.translation)
    assert error < 0.6 * np.linalg.norm(near.translation - true.translation)


def test_one_who_bends_down_is_not_taken_to_be_far_away() -> None:
    true = standing_posture(BODY, np.zeros(3))
    bent = np.zeros(BODY.skeleton.dof_count)
    bent[BODY.skeleton.dof_names.index("waist.rotation_x")] = 1.3
    found = place_standing(BODY, CAMERA, 0, film(Posture.stack([true.plus(bent)])), SEGMENTS)
    depth = [float(CAMERA.depth(posture.translation)) for posture in (true, found)]
    assert depth[1] == pytest.approx(depth[0], rel=0.15)


def test_a_ground_elsewhere_is_left_alone() -> None:
    camera = looking_down(0.3, (0.0, -4.0, 4.3))
    true = standing_posture(BODY, np.array([0.0, 0.0, 2.0]))
    from keymark.core.terms.region_model import MarkerPlacement, RegionModel

    model = RegionModel(BODY, camera, tuple(MarkerPlacement.usual(name) for name in SEGMENTS))
    found = place_standing(BODY, camera, 0, film(Posture.stack([true]), model=model), SEGMENTS)
    assert abs(soles_m(found) - 2.0) < 0.1


def test_without_regions_the_body_fills_seven_tenths_of_the_picture() -> None:
    found = place_standing(BODY, CAMERA)
    soles = found.translation - np.array([0.0, 0.0, hip_height_m(BODY)])
    crown = soles + np.array([0.0, 0.0, standing_height_m(BODY)])
    (low, high), depth = CAMERA.project(np.stack([soles, crown]))
    assert 0.6 < (low[1] - high[1]) / 240.0 < 0.8
    assert np.all(depth > 0.0)
    assert 0.0 <= high[1] < low[1] <= 240.0
    assert abs(soles[2]) < 1e-9


@pytest.mark.parametrize("heading", [0.0, 1.0, 2.5, -2.0])
def test_it_faces_the_camera_wherever_that_is(heading: float) -> None:
    toward = np.array([np.sin(heading), -np.cos(heading), 0.0])
    back = -toward
    matrix = np.eye(4)
    matrix[:3, :3] = np.column_stack([np.cross([0.0, 0.0, 1.0], toward), [0.0, 0.0, 1.0], -back])
    matrix[:3, 3] = 4.0 * toward + [0.0, 0.0, 1.0]
    found = place_standing(BODY, Camera(40.0, 36.0, (320, 240), matrix))
    front = found.rotations[0] @ [0.0, -1.0, 0.0]
    np.testing.assert_allclose(front, toward, atol=1e-9)


@pytest.mark.parametrize("camera", [CAMERA, looking_down(0.4, (0.3, -4.0, 3.0))])
def test_head_and_ground_tell_the_place(camera: Camera) -> None:
    place = np.array([0.4, 0.7, 0.1])
    pixels, _ = camera.project(np.stack([place + [0.0, 0.0, 1.8], place]))
    np.testing.assert_allclose(ground_place(camera, 0, 1.8, *pixels), place, atol=1e-6)


def test_pixels_that_cannot_be_a_person_are_refused() -> None:
    with pytest.raises(InputError, match="below the ground"):
        ground_place(CAMERA, 0, 1.8, (160.0, 220.0), (160.0, 30.0))
    with pytest.raises(InputError, match="pixels apart"):
        ground_place(CAMERA, 0, 1.8, (160.0, 100.0), (160.0, 110.0))


@pytest.mark.parametrize("share", [0.25, 0.5])
def test_a_trunk_that_is_hidden_in_part_does_not_send_the_body_away(share: float) -> None:
    true = standing_posture(BODY)
    tracks = seen(true)
    area = np.array(tracks.area)
    area[0, SEGMENTS.index("trunk")] *= share
    found = place_standing(BODY, CAMERA, 0, replace(tracks, area=area), SEGMENTS)
    depth = [float(CAMERA.depth(posture.translation)) for posture in (true, found)]
    assert abs(depth[1] / depth[0] - 1.0) < 0.06
