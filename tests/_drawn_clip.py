"""Clips drawn in memory with regions known exactly, and a network that sees colored discs as people."""

from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import cv2
import numpy as np
import pytest
from keymark.core.arrays import Image
from keymark.core.detect.keypoints import People
from keymark.core.detect.pose_network import CIRCLE, LAYOUT, Crop, Pose
from keymark.core.markers.ignored_regions import IgnoredRegion
from keymark.core.markers.markers import assign_detections, detect_markers
from keymark.core.markers.region_tracks import ExpectedRegions, MarkerStyle, RegionTracks
from keymark.core.video.clip import Clip

SIZE = (320, 240)
RED, BLUE = (200, 45, 50), (55, 90, 215)
STYLES = (MarkerStyle("red", "forearm.L", RED), MarkerStyle("blue", "forearm.R", BLUE))
FINE = 4  # points drawn a pixel and axis


@dataclass
class Drawn:
    """A clip drawn in memory, in the form of a decoder."""

    images: list[np.ndarray]
    fps: float = 30.0
    passes: int = 0
    decoded: int = 0
    size: tuple[int, int] = SIZE
    frame_count: int = field(init=False)

    def __post_init__(self) -> None:
        """Count the frames."""
        self.frame_count = len(self.images)

    def frames(self) -> Iterator[tuple[int, float, np.ndarray]]:
        """Yield every frame; how often that is done is counted."""
        self.passes += 1
        for index, image in enumerate(self.images):
            yield index, index / self.fps, image

    def time_stamps(self) -> Iterator[float]:
        """Yield every time."""
        yield from (index / self.fps for index in range(self.frame_count))

    def at(self, indices: list[int]) -> Iterator[tuple[int, np.ndarray]]:
        """Yield some frames."""
        yield from ((index, self.images[index]) for index in indices if index < self.frame_count)

    def onward(self, first: int) -> Iterator[tuple[float, np.ndarray]]:
        """Yield the frames from one on; how many is counted."""
        for index in range(max(first, 0), self.frame_count):
            self.decoded += 1
            yield index / self.fps, self.images[index]


def write_video(path: Path, levels: Sequence[int], fps: float = 25.0, code: str = "mp4v") -> Path:
    """A video of 64 by 48 pixels, each of whose frames has one gray level."""
    video = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*code), fps, (64, 48))
    assert video.isOpened()
    for level in levels:
        video.write(np.full((48, 64, 3), level, dtype=np.uint8))
    video.release()
    return path


Ellipse = tuple[tuple[int, int, int], tuple[float, float], tuple[float, float], float]


def draw(
    shapes: list[Ellipse], rng: np.random.Generator, noise: float = 2.0, light: float = 1.0
) -> np.ndarray:
    """Ellipses (color, center, half axes, degrees) with soft edges on a warm wall over a brown floor."""
    fine = _empty().copy()
    for color, (x, y), (a, b), angle in shapes:
        # OpenCV draws about the centers of pixels, with four bits of fraction.
        center = (round((x * FINE - 0.5) * 16), round((y * FINE - 0.5) * 16))
        axes = (round(a * FINE * 16), round(b * FINE * 16))
        cv2.ellipse(fine, center, axes, angle, 0, 360, color[::-1], -1, shift=4)
    image = cv2.resize(fine, SIZE, interpolation=cv2.INTER_AREA).astype(np.float64)
    return np.clip(image * light + rng.normal(0, noise, image.shape), 0, 255).astype(np.uint8)


@cache
def _empty() -> np.ndarray:
    """The scene without anything in it; filling it anew for each frame would be most of drawing it."""
    fine = np.zeros((SIZE[1] * FINE, SIZE[0] * FINE, 3), dtype=np.uint8)
    fine[:] = (176, 190, 200)
    fine[170 * FINE :] = (92, 112, 130)
    return fine


def clip_of(images: list[np.ndarray]) -> Clip:
    """A clip of images in memory."""
    return Clip(Path("drawn.mp4"), Drawn(images))


def finish(job: Generator[float, None, RegionTracks]) -> RegionTracks:
    """Drive the extraction to its end; its progress must rise from 0 to 1."""
    fractions = []
    while True:
        try:
            fractions.append(next(job))
        except StopIteration as stop:
            assert fractions[0] == 0.0 and fractions[-1] == pytest.approx(1.0)
            assert fractions == sorted(fractions)
            return stop.value


def track_markers(clip, styles, expected=None, ignored=()) -> Generator[float, None, RegionTracks]:
    """The markers of a clip, as a reading follows them."""
    yield 0.0
    seen = yield from detect_markers(clip, styles, expected, ignored)
    return assign_detections(seen, styles, expected)


def film(
    shapes: Callable[[int], list[Ellipse]], count: int, seed: int, noise: float = 2.0
) -> list[np.ndarray]:
    """So many pictures of what is there in each frame."""
    rng = np.random.default_rng(seed)
    return [draw(shapes(index), rng, noise) for index in range(count)]


def tracked(
    images: list[np.ndarray],
    styles: Sequence[MarkerStyle] = STYLES,
    expected: ExpectedRegions | None = None,
    ignored: Sequence[IgnoredRegion] = (),
) -> RegionTracks:
    """The markers of a clip of images."""
    return finish(track_markers(clip_of(images), styles, expected, ignored))


def path(index: int) -> tuple[float, float]:
    """Where the red ellipse is in a frame."""
    return 60.3 + 3.1 * index, 90.7 + 20.0 * np.sin(index / 5.0)


def moving(index: int) -> list[Ellipse]:
    """Red wanders and turns, blue stands still."""
    return [(RED, path(index), (16.0, 6.0), 5.0 * index), (BLUE, (250.5, 120.5), (8.0, 18.0), 0.0)]


PANEL = (20, 150, 90, 220)
"""Left, top, right, bottom of a red panel on the wall: sixteen times the area of the red marker."""


def with_panel(image: np.ndarray) -> np.ndarray:
    """A picture with a panel of the red marker's very color behind nobody."""
    left, top, right, bottom = PANEL
    panel = image.copy()
    panel[top:bottom, left:right] = RED[::-1]
    return panel


# --- A network in the place of the real one: it sees colored discs on black as people


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


class KnownPeople:
    """A finder that knows everyone already, however often a clip is shown to it."""

    def __init__(self, known: People) -> None:
        """Know some people."""
        self.known, self.count = known, 0

    def __enter__(self) -> "KnownPeople":
        return self

    def __exit__(self, *_error: object) -> None:
        """Nothing is left open."""

    def add(self, index: int, _picture: Image) -> None:
        """Count a frame."""
        self.count = index + 1

    def people(self) -> People:
        """Those who were known."""
        return self.known


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
