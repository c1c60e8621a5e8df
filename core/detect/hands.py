"""The turn of hands that a crop shows, by a network that sees 21 points of one (Zhang et al. 2020).

Every hand is looked at as it is and mirrored, since the network takes a palm for the back of a hand now and
then, but seldom in both. A hand is 22 numbers: its wrist [px], and of each look the turn as a rotation vector
[rad] in axes of the line of sight (x right, y down, z away), how sure it is that there is a hand, and that it
is the side's, 0 to 1, and the curls of its fingers [rad], the thumb's first. At rest it points to the
performer's side, palm down, thumb forward.
"""

from pathlib import Path

import numpy as np

from ..arrays import Array, BoolArray, Image, SingleArray
from ..body.fingers import MIDDLE, RESTING, WRIST, curls_of, palm_of
from ..body.rotations import exponential, logarithm
from ..body.skeleton import SIDES
from ..numerics.vectors import unit
from .keypoints import FACING, HAND_NUMBERS, no_hands
from .network_file import FOLDER, network_input, network_session
from .pose_network import LAYOUT, Crop, Pose

MODEL = FOLDER / "hand_landmark.onnx"
SIDE, POINTS = 224, 21  # of the network's input, and of its points
CROP_HANDS = 1.6  # side of a crop, in lengths of a hand, and then in sizes of what is seen of it
LENGTH_M = 0.19
SMALLEST_PX = 35.0  # length of a hand that shows nothing
OUTPUTS = ("Identity", "Identity_1", "Identity_2", "Identity_3")


class HandNetwork:
    """The network with its weights."""

    def __init__(self, model: Path = MODEL) -> None:
        self._session = network_session(model, "hands")

    def __call__(self, picture: Image, pose: Pose) -> Array:
        """(2, 22) a person's hands in a picture (height, width, 3), blue first; NaN where too small."""
        hands = no_hands()
        for row, side in enumerate(SIDES):
            crop = _first_crop(pose, side)
            if crop.side < CROP_HANDS * SMALLEST_PX:
                continue
            pixel = self._look(picture, crop, False)[0]
            up = pixel[MIDDLE] - pixel[WRIST]  # the next crop is about what is seen, fingers up
            crop = Crop.around(pixel, float(np.arctan2(up[0], -up[1])), CROP_HANDS)
            looks = [self._look(picture, crop, mirrored) for mirrored in (False, True)]
            hands[row, :2] = np.mean([pixel[WRIST] for pixel, *_ in looks], axis=0)
            hands[row, 2:] = np.concatenate(
                [
                    [*logarithm(hand_turn(place, side)), there, abs((side == "R") - left), *curls_of(place)]
                    for _, place, there, left in looks
                ]
            )
        return hands

    def _look(self, picture: Image, crop: Crop, mirrored: bool) -> tuple[Array, Array, float, float]:
        """(21, 2) points in the picture, (21, 3) in space, the presence, and how surely it is a left hand."""
        matrix = crop.matrix_of(SIDE)
        blob: SingleArray = network_input(picture, matrix, SIDE)
        if mirrored:
            blob = np.ascontiguousarray(blob[..., ::-1])
        points, presence, right, space = self._session.run(
            OUTPUTS, {self._session.get_inputs()[0].name: blob}
        )
        place, space = points.reshape(POINTS, 3)[:, :2].astype(np.float64), space.reshape(POINTS, 3)
        left = 1.0 - float(right.ravel()[0])
        if mirrored:
            place, space, left = [SIDE, 0.0] + place * [-1.0, 1.0], space * [-1.0, 1.0, 1.0], 1.0 - left
        turned = exponential(np.array([0.0, 0.0, crop.angle]))
        pixel = place @ matrix[:, :2].T + matrix[:, 2]
        return pixel, space @ turned.T, float(presence.ravel()[0]), left


def hand_turn(points: Array, side: str) -> Array:
    """(3, 3) turn from rest of a hand by its 21 points (21, 3), in the axes of these."""
    return palm_of(points, side) @ (FACING @ RESTING[side]).T


def hand_of(points: Array, wrist: Array, side: str) -> Array:
    """(22,) a hand of 21 points (21, 3) in space, as another network sees it, its wrist at a pixel (2,).

    Both looks are that one, of which it does not say how sure it is. NaN where the points are no hand's.
    """
    turn = hand_turn(points, side)
    if not np.isfinite(turn).all() or abs(float(np.linalg.det(turn))) < 0.5:
        return np.full(HAND_NUMBERS, np.nan)
    look = [*logarithm(turn), 0.9, 1.0, *curls_of(points)]
    return np.array([*wrist, *look, *look])


def alike(hands: Array) -> BoolArray:
    """(...) whether hands (..., 22) are another network's."""
    looks = hands[..., 2:].reshape(*hands.shape[:-1], 2, -1)
    return np.asarray((looks[..., 0, :] == looks[..., 1, :]).all(axis=-1))


def _first_crop(pose: Pose, side: str) -> Crop:
    """The crop about a hand by the pose's wrist and knuckles, fingers up."""
    wrist, index, little, elbow = (
        LAYOUT.names.index(f"{name}.{side}") for name in ("wrist", "index", "pinky", "elbow")
    )
    pixel, hint = pose.pixel, pose.hint_m
    length = LENGTH_M * pose.pixels_per_meter()
    ahead = unit(0.5 * (hint[index] + hint[little]) - hint[wrist])[:2]
    up = 0.5 * (pixel[index] + pixel[little]) - pixel[wrist]
    if np.hypot(*up) < 0.15 * length:  # it points at the viewer, or away
        up = pixel[wrist] - pixel[elbow]
    angle = float(np.arctan2(up[0], -up[1]))
    return Crop(pixel[wrist] + 0.5 * length * ahead, CROP_HANDS * length, angle)
