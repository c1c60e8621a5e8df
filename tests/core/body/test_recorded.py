"""The body's shape and postures, number by number."""

import numpy as np
from _libraries import random_posture
from _recorded import assert_recorded
from _scene import BODY, exercise
from keymark.core.body.body_volume import (
    body_pieces,
    lower_sole_m,
    rested,
    sole_heights_m,
    sole_places,
    standing_height_m,
    standing_posture,
)
from keymark.core.body.fingers import RESTING, finger_weights
from keymark.core.body.human import HUMAN, mass_weights
from keymark.core.body.human_mesh import HumanMesh
from keymark.core.body.mirror import mirrored
from keymark.core.body.posture import Posture, headings_rad, posture_to_json
from keymark.core.body.posture_fit import fit_posture, guess_posture
from keymark.core.body.posture_spline import cubic_spline
from keymark.core.body.rotations import right_jacobian, right_jacobian_inverse

POSTURES = Posture.stack([random_posture(seed) for seed in range(6)])


def test_the_skeleton_and_its_shape() -> None:
    assert_recorded("limits", HUMAN.limits[np.isfinite(HUMAN.limits)])
    assert_recorded("deviations", HUMAN.deviations, mass_weights(HUMAN))
    pieces = body_pieces(BODY)
    for field in ("start", "end", "half_widths", "sagittal", "lateral"):
        assert_recorded(f"pieces {field}", *(getattr(piece, field) for piece in pieces))
    assert_recorded("rings", *(piece.rings(8, 3, 4) for piece in pieces))
    lengths = BODY.actor.segments_m
    assert_recorded("lengths", [lengths[name] for name in sorted(lengths)], [standing_height_m(BODY)])


def test_kinematics() -> None:
    pose = BODY.pose(POSTURES)
    assert_recorded("points", BODY.points(pose), BODY.points(BODY.pose(mirrored(POSTURES))))
    assert_recorded("frames", pose.rotation, pose.origin)
    assert_recorded("soles", sole_places(BODY, pose), sole_heights_m(BODY, pose))
    assert_recorded("lower sole", lower_sole_m(BODY, POSTURES))
    assert_recorded("headings", headings_rad(POSTURES))
    assert_recorded("in files", *posture_to_json(POSTURES.lowered(0.1)).values(), share=2e-8)
    turned = Posture.rest(HUMAN, (6,)).plus(np.pi * np.eye(HUMAN.dof_count)[HUMAN.ball_dofs[:6, 0]])
    assert_recorded("half turns", *posture_to_json(turned, 3).values())
    assert_recorded("rested", rested(BODY, POSTURES, ("leg.L", "arm.R")).to_vector())
    for lowered in (0.0, 1.3):
        standing = standing_posture(BODY, np.array([0.2, 0.1, 0.0]), 0.4, lowered)
        assert_recorded(f"standing posture {lowered}", standing.to_vector())
    vectors = np.array([[0.1, -0.4, 0.9], [1e-5, 0.0, 0.0], [2.0, 1.0, -0.5]])
    assert_recorded("rotations", right_jacobian(vectors), right_jacobian_inverse(vectors))


def test_postures_between_and_of_points() -> None:
    knots, times = np.array([0.0, 7.0, 12.0, 20.0, 26.0, 30.0]), np.linspace(-2.0, 33.0, 40)
    assert_recorded("cubic", BODY.points(BODY.pose(cubic_spline(POSTURES, knots, times))))
    points = BODY.points(BODY.pose(exercise(30)[::5]))
    points = points + 0.01 * np.random.default_rng(0).normal(size=points.shape)
    assert_recorded("guess", guess_posture(BODY, points).to_vector())
    points[2, 5] = np.nan
    fit = fit_posture(BODY, points, exercise(30)[::5])
    assert_recorded("fit", BODY.points(BODY.pose(fit.posture)), share=1e-4)


def test_the_skin() -> None:
    mesh = HumanMesh.read()
    places = np.stack(np.meshgrid(*3 * [np.linspace(-1.2, 1.2, 9)]), axis=-1).reshape(-1, 3)
    weights = [finger_weights(places, side) for side in RESTING]
    assert_recorded("finger weights", *(each[name] for each in weights for name in sorted(each)))
    longer = {name: place * [1.1, 1.0, 1.05] for name, place in mesh.joints.items()}
    assert_recorded("skin", mesh.vertices, mesh.fitted(longer))
