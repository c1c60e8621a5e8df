"""Keypoints and depths against differences."""

import numpy as np
from _scene import BODY, CAMERA, exercise
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.detect.keypoints import BODY_POINTS, mirrored_point
from keymark.core.terms.depths import DepthLinks, point_depths
from keymark.core.terms.keypoints import USUAL_PLACES, KeypointModel

FRAMES = 4
FRAME = np.arange(FRAMES)
POSTURE = exercise(40)[np.array([0, 9, 21, 33])]
MODEL = KeypointModel.usual(BODY, CAMERA, BODY_POINTS)
LINKS = DepthLinks.between(BODY_POINTS, ("one",) * len(BODY_POINTS))


def test_every_body_point_has_a_place_and_principal_points_have_the_skeletons() -> None:
    assert set(USUAL_PLACES) == set(BODY_POINTS)
    pose = BODY.pose(POSTURE)
    own = [BODY_POINTS.index(name) for name in HUMAN.point_names]
    np.testing.assert_allclose(MODEL.world(pose)[:, own], BODY.points(pose), atol=1e-12)


def test_places_at_rest_are_where_people_have_them() -> None:
    rest = type(POSTURE).from_vector(HUMAN, np.zeros((1, HUMAN.dof_count)))
    at = dict(zip(BODY_POINTS, MODEL.world(BODY.pose(rest))[0], strict=True))
    assert at["nose"][1] < at["eye.L"][1] < at["ear.L"][1]
    assert at["toe.R"][1] < at["ankle.R"][1] < at["heel.R"][1]
    assert at["toe.R"][2] < at["ankle.R"][2]
    assert at["crown"][2] == max(place[2] for place in at.values())
    assert at["thumb.L"][1] < at["pinky.L"][1]
    assert at["wrist.L"][0] < at["index.L"][0]
    for name, place in at.items():
        np.testing.assert_allclose(at[mirrored_point(name)], place * [-1.0, 1.0, 1.0], atol=1e-12)


def numeric(values, step: float = 1e-6) -> np.ndarray:  # noqa: ANN001
    """Central difference of a function of one number."""
    return (values(step) - values(-step)) / (2.0 * step)


def test_jacobians_by_place_and_lens_are_differences() -> None:
    pose = BODY.pose(POSTURE)
    for axis in range(3):
        unit = np.zeros_like(MODEL.place)
        unit[:, axis] = 1.0
        pixels = numeric(lambda x, unit=unit: MODEL.changed(x * unit, CAMERA).pixels(pose, FRAME))
        np.testing.assert_allclose(MODEL.place_jacobian(pose, FRAME)[..., axis], pixels, atol=1e-4)
    zoomed = numeric(
        lambda x: MODEL.changed(
            0.0 * MODEL.place, type(CAMERA)(**{**vars(CAMERA), "lens_mm": CAMERA.lens_mm * np.exp(x)})
        ).pixels(pose, FRAME)
    )
    np.testing.assert_allclose(MODEL.lens_jacobian(pose, FRAME), zoomed, atol=1e-4)


def test_a_factor_scales_rows_and_leaves_points_out() -> None:
    pose = BODY.pose(POSTURE)
    factor = np.full((FRAMES, len(BODY_POINTS)), 2.0)
    factor[:, 3] = 0.0
    rows = MODEL.pixels_jacobian(pose, FRAME, factor)
    assert np.abs(rows[:, 3]).max() == 0.0
    np.testing.assert_allclose(rows[:, 4], 2.0 * MODEL.pixels_jacobian(pose, FRAME)[:, 4])


def test_links_take_what_a_layout_has() -> None:
    names = ("hip.L", "hip.R", "knee.L", "knee.R", "ankle.L", "ankle.R")
    links = DepthLinks.between(names, ("tracks",) * 6)
    assert sorted(links.names) == ["ankle", "ankle", "hips", "knee", "knee"]
    depth = np.arange(6.0)[None].repeat(2, axis=0)
    depth[1, 2] = np.nan
    guessed = dict(zip(links.names, links.guessed(depth).T, strict=True))
    assert guessed["hips"].tolist() == [-1.0, -1.0]
    assert np.isnan(links.guessed(depth)[1]).sum() == 2
    assert np.isfinite(links.guessed(depth)[0]).all()


def test_links_join_points_of_one_source_only() -> None:
    assert not len(DepthLinks.between(("hip.L", "knee.L"), ("detector", "tracks")).names)


BODY = Body(Actor.from_stature(1.75))


def camera_in_front(poses: int | None = None) -> Camera:
    """A camera 4 m before the performer, looking along +Y; one that backs away by 1 m a frame if asked."""
    matrix = np.array([[1.0, 0, 0, 0], [0, 0, -1, -4], [0, 1, 0, 0], [0, 0, 0, 1]])
    if poses is not None:
        matrix = np.tile(matrix, (poses, 1, 1))
        matrix[:, 1, 3] -= np.arange(poses)
    return Camera(40.0, 36.0, (320, 240), matrix)


def test_the_rest_posture_stands_at_the_cameras_distance() -> None:
    pose = BODY.pose(Posture.rest(HUMAN))
    np.testing.assert_allclose(point_depths(BODY, camera_in_front(), pose, 0), 4.0, atol=1e-12)
