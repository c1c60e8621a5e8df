"""The paper's observation: characteristics from both projected ends of each marked segment."""

import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.estimate.line_ends import (
    ANGLE,
    LOG_RATIO,
    LineEnds,
    X,
    Y,
    angle_weight,
    observed_characteristics,
    residual,
)
from keymark.core.markers.region_tracks import RegionTracks

BODY = Body(Actor.from_stature(1.75))
MARKED = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
FORWARD = np.array([[1.0, 0, 0, 0], [0, 0, -1, -4], [0, 1, 0, 0], [0, 0, 0, 1]])
"""A camera 4 m before the performer and level with the hips, looking along +Y."""
CAMERA = Camera(40.0, 36.0, (320, 240), FORWARD)
PIXELS_PER_METER = 40.0 / 36.0 * 320 / 4.0


def test_the_rest_posture_gives_values_worked_out_by_hand() -> None:
    seen = LineEnds(BODY, CAMERA, MARKED).evaluate(BODY.pose(Posture.rest(HUMAN)))
    actor = BODY.actor.segments_m
    trunk, forearm = seen[0], seen[1]
    assert trunk[X] == pytest.approx(160.0)
    assert trunk[Y] == pytest.approx(120.0 - 0.5 * actor["trunk"] * PIXELS_PER_METER)
    assert abs(trunk[ANGLE]) == pytest.approx(np.pi / 2)
    assert trunk[LOG_RATIO] == pytest.approx(np.log(1.0 + (actor["trunk"] / (0.185 * 1.75)) ** 2))
    elbow = 0.5 * actor["shoulder_width"] + actor["upper_arm.L"]
    assert forearm[X] == pytest.approx(160.0 + (elbow + 0.5 * actor["forearm.L"]) * PIXELS_PER_METER)
    assert forearm[ANGLE] == pytest.approx(0.0, abs=1e-12)


def test_a_segment_seen_end_on_is_round_and_without_direction() -> None:
    posture = Posture.rest(HUMAN)
    eye = np.array(CAMERA.matrix_world)
    eye[:3, :3] = [[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]  # from the performer's left along the stretched arms
    eye[:3, 3] = [4.0, 0.0, BODY.points(BODY.pose(posture))[HUMAN.point_names.index("wrist.L"), 2]]
    seen = LineEnds(BODY, Camera(40.0, 36.0, (320, 240), eye), ("forearm.L",)).evaluate(BODY.pose(posture))
    np.testing.assert_allclose(seen[0, [X, Y]], [160.0, 120.0], atol=1e-9)
    assert seen[0, LOG_RATIO] == pytest.approx(0.0, abs=1e-9)
    assert angle_weight(seen[0, LOG_RATIO]) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("distortion", [(0.0, 0.0, 0.0), (-0.12, 0.03, 0.0)])
def test_the_jacobian_agrees_with_central_differences_on_the_manifold(
    seed: int, distortion: tuple[float, float, float]
) -> None:
    rng = np.random.default_rng(seed)
    posture = Posture.rest(HUMAN).plus(rng.normal(0.0, 0.5, HUMAN.dof_count))
    poses = np.stack([FORWARD, FORWARD])
    poses[1, :3, 3] += rng.normal(0.0, 0.1, 3)
    observation = LineEnds(BODY, Camera(40.0, 36.0, (320, 240), poses, 0.02, -0.03, distortion), MARKED)
    step = 1e-6
    shifted = [
        observation.evaluate(BODY.pose(posture.plus(sign * step * np.eye(34))), np.ones(34, dtype=int))
        for sign in (1.0, -1.0)
    ]
    numeric = np.moveaxis(residual(*shifted), 0, -1) / (2.0 * step)
    analytic = observation.jacobian(BODY.pose(posture), 1)
    assert analytic.shape == (5, 4, 34)
    np.testing.assert_allclose(analytic, numeric, rtol=1e-5, atol=1e-4)


def test_a_segment_behind_the_camera_predicts_nothing() -> None:
    seen = LineEnds(BODY, CAMERA, MARKED).evaluate(BODY.pose(Posture.rest(HUMAN).plus(np.eye(34)[1] * -9.0)))
    assert np.isnan(seen).all()


@pytest.mark.parametrize(
    ("observed", "predicted", "expected"),
    [(1.5, -1.5, 3.0 - np.pi), (-1.5, 1.5, np.pi - 3.0), (0.2, 0.1, 0.1), (3.1, 0.0, 3.1 - np.pi)],
)
def test_angles_are_compared_modulo_half_a_turn(observed: float, predicted: float, expected: float) -> None:
    first, second = np.zeros(4), np.zeros(4)
    first[ANGLE], second[ANGLE] = observed, predicted
    assert residual(first, second)[ANGLE] == pytest.approx(expected)


def test_the_weight_of_an_angle_is_the_regions_elongation() -> None:
    np.testing.assert_allclose(angle_weight(np.log([1.0, 4.0, 1e6])), [0.0, 0.6, 1.0], atol=1e-5)


def test_characteristics_of_tracks_are_those_of_their_moments() -> None:
    turn = np.array([[np.cos(np.pi / 6), -np.sin(np.pi / 6)], [np.sin(np.pi / 6), np.cos(np.pi / 6)]])
    moment = turn @ np.diag([36.0, 4.0]) @ turn.T
    hidden = np.full((2, 2), np.nan)
    tracks = RegionTracks(
        names=("a", "b"),
        centroid=np.array([[[10.0, 20.0], [np.nan, np.nan]]]),
        second_moment=np.stack([moment, hidden])[None],
        area=np.array([[12.0, np.nan]]),
        quality=np.array([[1.0, 0.0]]),
        clipped=np.zeros((1, 2), dtype=bool),
        time_s=np.zeros(1),
        size=(320, 240),
    )
    seen = observed_characteristics(tracks)
    np.testing.assert_allclose(seen[0, 0], [10.0, 20.0, np.pi / 6, np.log(9.0)], rtol=1e-12)
    assert np.isnan(seen[0, 1]).all()
