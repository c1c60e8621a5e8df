"""A network in the place of the real one: it sees colored discs on black as people."""

from collections.abc import Sequence

import cv2
import numpy as np
from keymark.core.arrays import Image
from keymark.core.detect.pose_network import CIRCLE, LAYOUT, Crop, Pose

COUNT = len(LAYOUT.names)
BRIGHT = 100
SHAPE = np.random.default_rng(3).uniform(-0.8, 0.8, (COUNT, 2))
"""Of a person, in radii of the disc."""


class FakeNetwork:
    """Sees the disc that is nearest to the middle of a crop, where it fits the crop."""

    looks = 0

    def __call__(self, picture: Image, crop: Crop) -> Pose:
        """Look at a crop."""
        self.looks += 1
        found = cv2.connectedComponentsWithStats((picture.max(axis=2) > BRIGHT).astype(np.uint8))[2:]
        stats, centers = found[0][1:], found[1][1:]
        if not len(stats):
            return self._pose(crop.center, crop.side / CIRCLE, 0.0)
        nearest = int(np.hypot(*(centers - crop.center).T).argmin())
        radius = stats[nearest][2:4].max() / 2.0
        fits = 0.4 < CIRCLE * radius / crop.side < 2.0
        near = np.abs(centers[nearest] - crop.center).max() < 0.35 * crop.side
        return self._pose(centers[nearest], radius, float(fits and near))

    def each(self, asked: Sequence[tuple[Image, Crop]]) -> list[Pose]:
        """Look at one crop after the other."""
        return [self(*one) for one in asked]

    def _pose(self, center: np.ndarray, radius: float, presence: float) -> Pose:
        hint = np.zeros((COUNT, 3))
        crop = Crop(np.asarray(center, dtype=float), CIRCLE * float(radius))
        return Pose(center + radius * SHAPE, np.full(COUNT, 0.9), hint, presence, crop)


class MiddleNetwork(FakeNetwork):
    """Sees somebody in the middle of every picture."""

    presence = 1.0

    def __call__(self, picture: Image, crop: Crop) -> Pose:
        """Look at a crop."""
        self.looks += 1
        height, width = picture.shape[:2]
        middle = np.array([width / 2 + 0.1 * np.sin(self.looks), height / 2])  # as no two looks are the same
        return self._pose(middle, height / CIRCLE, self.presence)


def draw_people(size: tuple[int, int], people: list[tuple[float, float, float]]) -> Image:
    """A picture of people, each with x, y and radius."""
    picture = np.zeros((size[1], size[0], 3), dtype=np.uint8)
    for x, y, radius in people:
        cv2.circle(picture, (round(x), round(y)), round(radius), (255, 255, 255), -1)
    return picture
