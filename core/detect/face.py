"""The turn of a face that a crop shows, by a network that sees its 468 points (Kartynnik et al. 2019).

A face is six numbers: its middle [px], the turn from facing the viewer upright as a rotation vector [rad] in
axes of the line of sight (x right, y down, z away), and how sure the network is that there is one, 0 to 1.
"""

from pathlib import Path

import numpy as np

from ..arrays import Array, Image
from ..body.rotations import exponential, logarithm
from ..numerics.vectors import unit
from .keypoints import no_face
from .network_file import FOLDER, network_input, network_session
from .pose_network import LAYOUT, Crop, Pose

MODEL = FOLDER / "face_landmark.onnx"
SIDE, POINTS = 192, 468  # of the network's input, and of its points
CROP_M, CROP_SIZES = 0.3, 1.5  # side of the first crop, and of the second in sizes of the face
SMALLEST_PX = 26.0  # side of a crop whose face shows nothing, of 20 pixels
HALVES = ((263, 33), (362, 133), (454, 234), (291, 61), (323, 93), (361, 132), (397, 172), (356, 127))
"""Points of the left half of the face and their mirror images: corners of eyes and mouth, the contour."""
TOP, CHIN = 10, 152
OUTPUTS = ("conv2d_21", "conv2d_31")
AROUND = [LAYOUT.names.index(name) for name in ("nose", "eye.L", "eye.R", "ear.L", "ear.R")]


class FaceNetwork:
    """The network with its weights."""

    def __init__(self, model: Path = MODEL) -> None:
        self._session = network_session(model, "faces")

    def __call__(self, picture: Image, pose: Pose) -> Array:
        """(6,) a person's face in a picture (height, width, 3), blue first; NaN where it is too small."""
        crop = _first_crop(pose)
        if crop.side < SMALLEST_PX:
            return no_face()
        # The first look finds the face, the second sees it as the network has learned it: upright, all of it.
        for _ in range(2):
            points, presence = self._look(picture, crop)
            turn, middle, crop = _seen(points, crop)
        return np.array([*middle, *logarithm(turn), presence])

    def _look(self, picture: Image, crop: Crop) -> tuple[Array, float]:
        """(468, 3) points in the crop's pixels, z away, and the presence."""
        blob = network_input(picture, crop.matrix_of(SIDE), SIDE)
        points, presence = self._session.run(OUTPUTS, {self._session.get_inputs()[0].name: blob})
        sure = 1.0 / (1.0 + np.exp(-float(presence.ravel()[0])))
        return points.reshape(POINTS, 3).astype(np.float64), sure


def _first_crop(pose: Pose) -> Crop:
    """The crop about eyes and nose, as large as their places in space say, upright with the person."""
    middle = pose.pixel[AROUND[:3]].mean(axis=0)
    return Crop(middle, CROP_M * pose.pixels_per_meter(AROUND), pose.crop.angle)


def _seen(points: Array, crop: Crop) -> tuple[Array, Array, Crop]:
    """The turn (3, 3) of a face in a crop, its middle (2,) in the picture, and the crop to see it best."""
    matrix = crop.matrix_of(SIDE)
    pixel = points[:, :2] @ matrix[:, :2].T + matrix[:, 2]
    left, right = np.array(HALVES).T
    across = (points[left] - points[right]).mean(axis=0)
    down = points[CHIN] - points[TOP]
    across, down = unit(across), unit(down - down @ unit(across) * unit(across))
    turned = exponential(np.array([0.0, 0.0, crop.angle]))
    turn = turned @ np.column_stack([across, down, np.cross(across, down)])
    upright = pixel[CHIN] - pixel[TOP]
    best = Crop.around(pixel, float(np.arctan2(-upright[0], upright[1])), CROP_SIZES)
    return turn, pixel.mean(axis=0), best
