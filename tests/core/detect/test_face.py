"""A face's turn: of points as a crop shows them, about the line of sight, and as evidence in the world."""

from typing import Any

import numpy as np
import pytest
from _scene import CAMERA
from keymark.core.body.rotations import exponential, logarithm, smallest
from keymark.core.detect.face import CHIN, HALVES, POINTS, SIDE, TOP, FaceNetwork
from keymark.core.detect.keypoints import FACE, FACING, Keypoints
from keymark.core.detect.pose_network import LAYOUT, Crop, Pose
from keymark.core.terms.head import FLIP, NEAR_STD_RAD, POINTS_STD_RAD, USUAL_FACE, ObservedHeads

MIDDLE, SIZE_PX = np.array([300.0, 200.0]), 80.0


def upright_face() -> np.ndarray:
    """(468, 3) points of a face of height 1 about its middle, in axes of its viewer."""
    points = np.random.default_rng(2).uniform(-0.35, 0.35, (POINTS, 3))
    points[TOP], points[CHIN] = (0.0, -0.5, 0.0), (0.0, 0.5, 0.0)
    for number, (left, right) in enumerate(HALVES):
        points[left] = (0.1 + 0.03 * number, 0.04 * number, 0.02 * number)
        points[right] = points[left] * [-1.0, 1.0, 1.0]
    return points


class Drawn(FaceNetwork):
    """A network that sees one face of a known turn, wherever the crop is."""

    def __init__(self, turn: np.ndarray) -> None:
        """Place the face's points in the picture."""
        self.points = upright_face() @ turn.T * SIZE_PX + [*MIDDLE, 0.0]
        self.crops: list[Crop] = []

    def _look(self, picture: Any, crop: Crop) -> tuple[np.ndarray, float]:
        self.crops.append(crop)
        back = crop.turn.T * SIDE / crop.side
        pixel = (self.points[:, :2] - crop.center) @ back.T + SIDE / 2
        return np.column_stack([pixel, self.points[:, 2] * SIDE / crop.side]), 0.9


def person(scale: float = 200.0, angle: float = 0.0) -> Pose:
    hint = np.random.default_rng(1).normal(size=(len(LAYOUT.names), 3)) * 0.1
    crop = Crop(MIDDLE, 500.0, angle)
    return Pose(MIDDLE + scale * hint[:, :2], np.ones(len(hint)), hint, 0.9, crop)


@pytest.mark.parametrize("rolled", [0.0, 2.5])
def test_the_turn_is_that_of_the_points_in_any_crop(rolled: float) -> None:
    turn = exponential(np.array([0.0, 0.0, rolled])) @ exponential(np.array([0.2, -0.6, 0.1]))
    network = Drawn(turn)
    face = network(np.zeros((4, 4, 3), dtype=np.uint8), person(angle=rolled))
    np.testing.assert_allclose(exponential(face[2:5]), turn, atol=1e-9)
    np.testing.assert_allclose(face[:2], network.points[:, :2].mean(axis=0), atol=1e-9)
    first, second = network.crops
    assert first.side == pytest.approx(60.0) and first.angle == rolled and face[5] == 0.9
    upright = (network.points[CHIN] - network.points[TOP])[:2] @ second.turn
    assert abs(upright[0]) < 1e-9 < upright[1]


def test_a_small_head_is_not_looked_at() -> None:
    assert np.isnan(Drawn(np.eye(3))(np.zeros((4, 4, 3), dtype=np.uint8), person(60.0))).all()


def test_heads_in_the_world() -> None:
    rng = np.random.default_rng(4)
    world = exponential(rng.normal(size=(4, 3)) * 0.2)
    pixel = np.array([[20.0, 30.0], [300.0, 200.0], [160.0, 100.0], [50.0, 50.0]])
    axes = CAMERA.pose()[0] @ FLIP
    axes = smallest(np.tile(axes[:, 2], (4, 1)), CAMERA.rays(pixel)[1]) @ axes
    seen = np.swapaxes(axes, -1, -2) @ world @ FACING.T
    hint = USUAL_FACE @ np.swapaxes(seen @ FACING, -1, -2)
    face = np.column_stack([pixel, logarithm(seen), [0.99, 0.5, 0.99, 0.99]])
    face[2, 2:5] = logarithm(seen[2] @ exponential(np.array([0.0, np.pi, 0.0])))  # from behind
    face[3] = np.nan
    points = (np.zeros((4, 5, 2)), np.ones((4, 5)))
    heads = ObservedHeads.of(Keypoints(FACE, ("any",) * 5, *points, hint, (), face), CAMERA)
    assert heads is not None
    np.testing.assert_allclose(heads.turn[:3], world[:3], atol=1e-6)
    assert heads.std_rad.tolist() == [NEAR_STD_RAD, POINTS_STD_RAD, POINTS_STD_RAD, np.inf]
    assert ObservedHeads.of(Keypoints(FACE, ("any",) * 5, *points, hint), CAMERA) is None
