"""The strip that stands for a take: every frame shows the performer, near or far, with the skeleton."""

from dataclasses import replace

import numpy as np
import pytest
from _synthetic_take import BODY, SIZE, true_postures, write_synthetic_take
from keymark.core.arrays import Image
from keymark.core.report import strip_layout as strip
from keymark.core.report.canvas import LEFT, RIGHT
from keymark.core.report.film_strip import film_strip
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

FRAMES = 12


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    """A take, whose clip is not read."""
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("strip") / "take", FRAMES))


@pytest.fixture
def motion() -> Motion:
    """The true motion of that take."""
    posture = true_postures(FRAMES)
    points = BODY.points(BODY.pose(posture))
    unknown = np.full((FRAMES, 13, 3, 3), np.nan)
    return Motion(BODY, 30.0, 1, np.arange(FRAMES) / 30.0, posture, points, unknown, (0,), "map")


def moved(motion: Motion, meters: list[float]) -> Motion:
    """The motion, moved."""
    delta = np.zeros(len(BODY.skeleton.dof_names))
    delta[:3] = meters
    posture = motion.posture.plus(np.tile(delta, (FRAMES, 1)))
    return replace(motion, posture=posture, points=BODY.points(BODY.pose(posture)))


def plain(scale: int = 1) -> Image:
    """A gray frame."""
    return np.full((scale * SIZE[1], scale * SIZE[0], 3), 128, dtype=np.uint8)


def height(picture: Image) -> int:
    """Number of rows of a picture that the limbs fill."""
    limbs = np.zeros(picture.shape[:2], dtype=bool)
    for color in (LEFT, RIGHT):
        limbs |= np.abs(picture.astype(int) - color).max(axis=-1) <= 40
    return int(np.ptp(np.flatnonzero(limbs.any(axis=1)))) if limbs.any() else 0


def tiles(picture: Image) -> list[Image]:
    """The pictures of a strip."""
    step = strip.SIDE + strip.GAP
    return [picture[:, left : left + strip.SIDE] for left in range(0, strip.SIZE[0], step)]


@pytest.mark.parametrize("away_m", [0.0, 6.0])
def test_a_performer_far_away_is_as_large_as_one_that_is_near(
    take: Take, motion: Motion, away_m: float
) -> None:
    """Each picture is filled by the figure, whose size in the footage does not matter."""
    there = moved(motion, [0.5, away_m, 0.0])
    picture = film_strip(take, there, {frame: plain() for frame in range(0, FRAMES, 2)})
    assert picture.shape == (*strip.SIZE[::-1], 3)
    heights = [height(tile) for tile in tiles(picture)]
    assert min(heights) > 0.45 * strip.SIDE and max(heights) < 0.95 * strip.SIDE


def test_short_clips_and_reduced_frames(take: Take, motion: Motion) -> None:
    """One frame leaves the rest of the strip empty; a frame at twice the size gives the same picture."""
    picture = film_strip(take, motion, {3: plain()})
    first, *others = tiles(picture)
    assert height(first) > 0 and all(np.ptp(tile.reshape(-1, 3), axis=0).max() == 0 for tile in others)
    assert np.abs(picture.astype(int) - film_strip(take, motion, {3: plain(2)})).max() <= 1


@pytest.mark.parametrize("place", [[0.0, -50.0, 0.0], [40.0, 0.0, 0.0], [0.0, -3.9, 0.0]])
def test_an_estimate_that_left_the_picture_shows_the_footage(
    take: Take, motion: Motion, place: list[float]
) -> None:
    """A performer behind the camera, far beside it or very near still gives a picture."""
    image = plain()
    image[::8] = 255
    for tile in tiles(film_strip(take, moved(motion, place), {frame: image for frame in range(6)})):
        assert tile.std() > 5.0
