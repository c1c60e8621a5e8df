"""A hand's turn: of points as crops show them, plain and mirrored, about the line of sight."""

from typing import Any

import numpy as np
import pytest
from keymark.core.body.fingers import INDEX, LITTLE, MIDDLE, RESTING, WRIST, curls_of
from keymark.core.body.rotations import exponential
from keymark.core.detect.hands import POINTS, SIDE, HandNetwork, hand_turn
from keymark.core.detect.keypoints import FACING
from keymark.core.detect.pose_network import LAYOUT, Crop, Pose

MIDDLE_PX, SIZE_PX = np.array([300.0, 200.0]), 400.0


def resting(side: str) -> np.ndarray:
    """(21, 3) points of a hand that rests [m]: knuckles and fingers along it, thumb before it."""
    points = np.random.default_rng(2).uniform(-0.01, 0.01, (POINTS, 3))
    points[WRIST], points[MIDDLE] = (0.0, 0.0, 0.0), (0.09, 0.0, 0.0)
    points[INDEX], points[LITTLE] = (0.09, 0.03, 0.0), (0.08, -0.04, 0.0)
    return points @ (FACING @ RESTING[side]).T


class Session:
    """What sees one hand of a known turn wherever the crop is, if it is looked at as a right or left one."""

    def __init__(self, network: HandNetwork, points: np.ndarray, side: str) -> None:
        """Keep the hand in the picture."""
        self.points, self.side, self.crop, self.network = points, side, Crop(MIDDLE_PX, 1.0), network

    def get_inputs(self) -> list[Any]:
        return [self]

    name = "input"

    def run(self, _outputs: object, fed: dict[str, np.ndarray]) -> list[np.ndarray]:
        mirrored = fed["input"][0, 0, 0, 0] > 0.5  # the picture's right half is white
        pixel = MIDDLE_PX + SIZE_PX * self.points[:, :2]
        place = (pixel - self.crop.center) @ self.crop.turn * SIDE / self.crop.side + SIDE / 2
        space = self.points @ exponential(np.array([0.0, 0.0, self.crop.angle]))
        if mirrored:
            place, space = [SIDE, 0.0] + place * [-1.0, 1.0], space * [-1.0, 1.0, 1.0]
        right = 0.9 if (self.side == "R") != mirrored else 0.1
        flat = np.column_stack([place, np.zeros(POINTS)]).reshape(1, -1)
        return [flat, np.array([[0.8]]), np.array([[right]]), space.reshape(1, -1)]


@pytest.mark.parametrize("side", ["L", "R"])
def test_both_looks_tell_the_turn(side: str, monkeypatch: pytest.MonkeyPatch) -> None:
    turn = exponential(np.array([0.4, -0.7, 0.9]))
    network = HandNetwork.__new__(HandNetwork)
    session = network._session = Session(network, resting(side) @ turn.T, side)

    def shown(_picture: object, matrix: np.ndarray, _side: int) -> np.ndarray:
        session.crop = Crop(
            matrix @ [SIDE / 2, SIDE / 2, 1.0],
            float(np.hypot(*matrix[:, 0]) * SIDE),
            float(np.arctan2(matrix[1, 0], matrix[0, 0])),
        )
        blob = np.zeros((1, 3, SIDE, SIDE), dtype=np.float32)
        blob[..., SIDE // 2 :] = 1.0
        return blob

    monkeypatch.setattr("keymark.core.detect.hands.network_input", shown)
    hint = np.random.default_rng(1).normal(size=(len(LAYOUT.names), 3)) * 0.3
    pose = Pose(MIDDLE_PX + 400.0 * hint[:, :2], np.ones(len(hint)), hint, 0.9, Crop(MIDDLE_PX, 500.0))
    hand = network(np.zeros((4, 4, 3), dtype=np.uint8), pose)["LR".index(side)]
    np.testing.assert_allclose(hand[:2], MIDDLE_PX, atol=1e-6)
    for look in (hand[2:12], hand[12:]):
        np.testing.assert_allclose(exponential(look[:3]), turn, atol=1e-6)
        np.testing.assert_allclose(look[3:5], (0.8, 0.9))
        np.testing.assert_allclose(look[5:], curls_of(resting(side)), atol=1e-6)
    assert not np.allclose(hand_turn(resting(side), "R" if side == "L" else "L"), np.eye(3))
    small = Pose(MIDDLE_PX + 100.0 * hint[:, :2], np.ones(len(hint)), hint, 0.9, Crop(MIDDLE_PX, 500.0))
    assert np.isnan(network(np.zeros((4, 4, 3), dtype=np.uint8), small)).all()
