"""MediaPipe's landmark network, which sees one person in a square crop (BlazePose, Bazarevsky et al. 2020).

onnxruntime runs it on the processor. It has learned crops about the hips with the person upright, so that the
crop must move and turn with the person: `Pose.crop` is where to look next.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

import cv2
import numpy as np

from ..arrays import Array, Image, SingleArray
from .keypoints import no_face, no_hands
from .layouts import LAYOUTS
from .network_file import FOLDER, network_input, network_session

MODEL = FOLDER / "pose_landmark.onnx"
"""The weights, which are no part of the source: `tools/fetch_model.py` puts them here."""
NAME = "BlazePose"
LAYOUT = LAYOUTS["blazepose33"]
SIDE, CELLS = 256, 64  # of the network's input and of its heat maps
POINTS, CENTER, ABOVE = 39, 33, 34
"""Point 33 is between the hips, 34 above it on the circle about the whole person."""
CIRCLE = 2.5  # side of a crop by the circle's radius
NEIGHBORS = 3  # a point goes to the middle of its heat map within so many cells
MOST_AT_ONCE = 2  # looks: one person is followed two ways
OUTPUTS = ("Identity", "Identity_1", "Identity_3", "Identity_4")  # as `tools/fetch_model.py` keeps them

LARGE_BYTES = 2**24  # only the large network is larger
TOO_FAR_M = {
    "eye": (0.018, -0.018),
    "ear": (-0.005, 0.005),
    "shoulder": (-0.027, 0.027),
    "elbow": (-0.058, -0.042),
    "wrist": (0.013, -0.063),
    "hip": (0.024, -0.024),
    "knee": (0.01, -0.01),
    "ankle": (0.008, -0.008),
}
"""How far beyond their places the large network has points on the left and on the right [m].

By twice their difference it contradicts itself in mirror images, in every clip alike; arms come 5 and 2 cm
too near, by ten clips with truth.
"""

Item = TypeVar("Item")
Seen = TypeVar("Seen")


def in_parallel(look: Callable[[Item], Seen], items: Sequence[Item]) -> list[Seen]:
    """What looks see, in order; a look must not call this itself.

    Two at a time with one thread each are faster than several threads for one.
    """
    return list(_threads(max(1, min(cv2.getNumThreads(), MOST_AT_ONCE))).map(look, items))


@lru_cache
def _threads(count: int) -> ThreadPoolExecutor:
    """Threads that stay: each new one would take memory of its own, which the system does not get back."""
    return ThreadPoolExecutor(count)


@dataclass(frozen=True, eq=False)
class Crop:
    """A square of a picture, which may reach beyond it."""

    center: Array  # (2,) [px]
    side: float  # [px]
    angle: float = 0.0  # clockwise turn of the person within the picture [rad]

    @classmethod
    def around(cls, pixel: Array, angle: float, share: float) -> "Crop":
        """The smallest, turned so far, about points (N, 2) of a picture, so many times as large."""
        turn = cls(pixel[0], 1.0, angle).turn
        within = pixel @ turn
        low, high = within.min(axis=0), within.max(axis=0)
        return cls(turn @ (0.5 * (low + high)), share * float((high - low).max()), angle)

    @property
    def matrix(self) -> Array:
        """(2, 3) from the network's pixels to the picture's, origin at outer corners."""
        return self.matrix_of(SIDE)

    def matrix_of(self, pixels: int) -> Array:
        """(2, 3) the same of a network that sees so many pixels a side."""
        turn = self.side / pixels * self.turn
        return np.column_stack([turn, self.center - turn @ np.full(2, pixels / 2)])

    @property
    def turn(self) -> Array:
        """(2, 2) rotation from the crop to the picture."""
        cos, sin = np.cos(self.angle), np.sin(self.angle)
        return np.array([[cos, -sin], [sin, cos]])


@dataclass(frozen=True, eq=False)
class Look:
    """A person as another network sees one, N points of its layout."""

    pixel: Array  # (N, 2) [px]
    score: Array | None  # (N,) the network's own; None where it has none
    hint_m: Array | None = None  # (N, 3) as in `Keypoints`, NaN where there is none
    depth_m: Array | None = None  # (N,) depths alone, as those of hints, where it guesses these
    hands: Array | None = None  # (2, 22) as in `hands`, where it sees their points in space
    fingers: Array | None = None  # (2, 21, 3) points of hands [px] with depths [m]; NaN where not seen


@dataclass(frozen=True, eq=False)
class Pose:
    """A person as the network sees one, N points of `LAYOUT`."""

    pixel: Array  # (N, 2) [px]
    score: Array  # (N,) 0 to 1
    hint_m: Array  # (N, 3) as in `Keypoints`
    presence: float  # how sure it is that the crop shows anybody, 0 to 1
    crop: Crop  # about this person
    face: Array = field(default_factory=no_face)  # (6,) as in `face`, NaN where not looked at
    hands: Array = field(default_factory=no_hands)  # (2, 22) as in `hands`, likewise

    def pixels_per_meter(self, points: Sequence[int] | slice = slice(None)) -> float:
        """Size of some points in the picture over that of the guess of them in space, across the view."""
        pixel, hint = self.pixel[points], self.hint_m[points, :2]
        apart, apart_m = pixel - pixel.mean(axis=0), hint - hint.mean(axis=0)
        return float(np.sqrt((apart**2).sum() / max(float((apart_m**2).sum()), 1e-9)))


class PoseNetwork:
    """The network with its weights."""

    too_far_m: Array | float = 0.0
    """(N,) how far beyond their places it has the points of `LAYOUT` [m]."""

    def __init__(self, model: Path = MODEL) -> None:
        self._session = network_session(model, "keypoints")
        if model.stat().st_size > LARGE_BYTES:
            parts = [name.partition(".") for name in LAYOUT.names]
            sided = [(TOO_FAR_M.get(stem, (0.0, 0.0)), side) for stem, _, side in parts]
            self.too_far_m = np.array([off[side == "R"] for off, side in sided])

    def __call__(self, picture: Image, crop: Crop) -> Pose:
        """The person in a crop of a picture (height, width, 3), blue first."""
        return self.each([(picture, crop)])[0]

    def each(self, looks: Sequence[tuple[Image, Crop]]) -> list[Pose]:
        """The persons in crops of pictures."""
        seen = in_parallel(lambda look: self.infer(self.preprocess(*look)), looks)
        return [self.postprocess(out, crop) for out, (_, crop) in zip(seen, looks, strict=True)]

    def preprocess(self, picture: Image, crop: Crop) -> SingleArray:
        """The network's input (1, 3, 256, 256), red first, 0 to 1."""
        return network_input(picture, crop.matrix, SIDE)

    def infer(self, blob: SingleArray) -> tuple[SingleArray, float, SingleArray, SingleArray]:
        """Points (39, 5), presence, heat maps (39, 64, 64) and points in space (39, 3)."""
        (name,) = (one.name for one in self._session.get_inputs())
        points, presence, heat, world = self._session.run(OUTPUTS, {name: blob})
        return (
            points.reshape(POINTS, 5),
            float(presence[0, 0]),
            heat.reshape(POINTS, CELLS, CELLS),
            world.reshape(POINTS, 3),
        )

    def postprocess(self, out: tuple[SingleArray, float, SingleArray, SingleArray], crop: Crop) -> Pose:
        """The pose in the picture."""
        points, presence, heat, world = out
        place = np.array([_refined(point[:2], map_) for point, map_ in zip(points, heat, strict=True)])
        matrix = crop.matrix
        pixel = place @ matrix[:, :2].T + matrix[:, 2]
        up = pixel[ABOVE] - pixel[CENTER]
        around = Crop(pixel[CENTER], CIRCLE * float(np.hypot(*up)), float(np.arctan2(up[0], -up[1])))
        hint = world.astype(np.float64)
        hint[:, :2] = hint[:, :2] @ crop.turn.T
        used = LAYOUT.numbers
        hint[used, 2] -= self.too_far_m
        return Pose(pixel[used], _sigmoid(points[used, 3]), hint[used], float(presence), around)


def _refined(place: SingleArray, heat: SingleArray) -> Array:
    """(2,) a point [px of the crop] moved to the peak that its heat map has about it, if any."""
    size = SIDE / CELLS
    column, row = (int(value) for value in np.floor(place / size))
    if not (0 <= column < CELLS and 0 <= row < CELLS):
        return place.astype(np.float64)
    first = np.maximum([column - NEIGHBORS, row - NEIGHBORS], 0)
    part = _sigmoid(heat[first[1] : row + NEIGHBORS + 1, first[0] : column + NEIGHBORS + 1])
    if part.max() < 0.5:  # no peak
        return place.astype(np.float64)
    rows, columns = np.indices(part.shape)
    middle = np.array([(columns * part).sum(), (rows * part).sum()]) / part.sum()
    return np.asarray((first + middle) * size)


def _sigmoid(value: SingleArray) -> Array:
    return np.asarray(1.0 / (1.0 + np.exp(-np.clip(value, -60.0, 60.0).astype(np.float64))))
