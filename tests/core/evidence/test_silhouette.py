"""Silhouettes of tapered elliptical cylinders against shapes whose area and moments are known."""

import numpy as np
import pytest
from _scene import BODY, CAMERA
from keymark.core.body.body_volume import Piece, PieceStack
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.evidence.occlusion import sample_silhouette, view_pieces
from keymark.core.footage.camera import Camera

LENGTH, WIDE, DEEP = 0.4, 0.12, 0.05
FRAME = np.zeros(1, dtype=np.intp)


def upright(first: float = 1.0, last: float = 1.0) -> PieceStack:
    """An upright cylinder at the hips, with given half-widths at either end."""
    widths = np.array([[WIDE, DEEP]]) * np.array([[first], [last]])
    return PieceStack.of(
        [
            Piece(
                "trunk",
                0,
                np.array([0.0, 0.0, -LENGTH / 2]),
                np.array([0.0, 0.0, LENGTH / 2]),
                np.array([1.0, 0.0, 0.0]),
                np.array([0.0, 1.0, 0.0]),
                widths,
            )
        ]
    )


def at_camera_height(turn: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Posture:
    """The hips at the camera's height, turned by a rotation vector."""
    vector = np.zeros((1, HUMAN.dof_count))
    vector[0, 2] = 1.0
    vector[0, 3:6] = turn
    return Posture.from_vector(HUMAN, vector)


def seen(pieces: PieceStack, posture: Posture, camera: Camera = CAMERA):  # noqa: ANN201
    pose = BODY.pose(posture)
    return sample_silhouette(pieces, view_pieces(pieces, pose, camera, FRAME))


def test_a_cylinder_from_the_front_fills_a_rectangle() -> None:
    """Area 2wL, and the second moments of a rectangle across and along."""
    samples = seen(upright(), at_camera_height())
    area = samples.area[0, 0]
    assert area.sum() == pytest.approx(2 * WIDE * LENGTH, rel=1e-3)
    place = samples.world[0, 0]
    weight = area / area.sum()
    assert weight @ place[:, 2] == pytest.approx(1.0, abs=1e-6)
    assert weight @ place[:, 0] ** 2 == pytest.approx(WIDE**2 / 3, rel=0.08)
    assert weight @ (place[:, 2] - 1.0) ** 2 == pytest.approx(LENGTH**2 / 12, rel=0.03)


def test_a_cylinder_from_above_shows_its_elliptical_end() -> None:
    samples = seen(upright(), at_camera_height((np.pi / 2, 0.0, 0.0)))
    assert samples.area[0, 0].sum() == pytest.approx(np.pi * WIDE * DEEP, rel=1e-2)


@pytest.mark.parametrize("yaw", [0.3, 0.8, np.pi / 2])
def test_a_turned_trunk_shows_the_width_of_its_ellipse(yaw: float) -> None:
    samples = seen(upright(), at_camera_height((0.0, 0.0, yaw)))
    half = np.hypot(WIDE * np.cos(yaw), DEEP * np.sin(yaw))
    assert samples.area[0, 0].sum() == pytest.approx(2 * half * LENGTH, rel=1e-3)


def test_a_taper_moves_the_centroid_towards_the_thick_end() -> None:
    """A trapezoid's centroid lies at L/3 · (a + 2b) / (a + b) from the side of length a."""
    samples = seen(upright(0.5, 1.0), at_camera_height())
    weight = samples.area[0, 0] / samples.area[0, 0].sum()
    expected = LENGTH / 3 * (0.5 + 2.0) / 1.5 - LENGTH / 2
    assert weight @ samples.world[0, 0, :, 2] - 1.0 == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("seed", range(6))
def test_area_rates_agree_with_central_differences(seed: int) -> None:
    rng = np.random.default_rng(seed)
    far = Camera(4000.0, 36.0, (320, 240), CAMERA.matrix_world - 400 * np.outer([0, 1, 0, 0], [0, 0, 0, 1]))
    base = at_camera_height(tuple(rng.normal(size=3) * 0.8))
    rate = seen(upright(0.6, 1.0), base, far).area_rate[0, 0].sum(0)
    step = 1e-6
    for axis in range(3):
        # A world rotation w acts on the body's own tangent as Rᵀ w.
        tangent = np.zeros((1, HUMAN.dof_count))
        tangent[0, 3:6] = base.rotations[0, 0].T[:, axis] * step
        ahead, behind = (
            seen(upright(0.6, 1.0), base.plus(sign * tangent), far).area[0, 0].sum() for sign in (1, -1)
        )
        assert rate[axis] == pytest.approx((ahead - behind) / (2 * step), abs=2e-4)
