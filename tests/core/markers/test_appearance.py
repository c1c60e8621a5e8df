"""How surfaces look: colors of parts and bands, and backgrounds."""

import numpy as np
import pytest
from _synthetic_take import COLORS, drawn_frames, true_postures
from keymark.core.markers.appearance import (
    BANDS,
    NO_PART,
    Appearance,
    BandColors,
    band_cells,
    learn_appearance,
    learn_band_colors,
)
from keymark.core.markers.color_model import chromaticity, strong_colors

PLACE = np.kron(np.random.default_rng(1).uniform(60, 220, size=(6, 8, 3)), np.ones((10, 10, 1)))
RED = np.array([40.0, 40.0, 210.0])
FRAMES = 12


def walk_by(shake: int = 0, stays: bool = False) -> Appearance:
    """What is learned of a red block that crosses a still background, or stays, or before a shaken camera."""
    rng = np.random.default_rng(2)
    images, labels = [], []
    for frame in range(FRAMES):
        label = np.full(PLACE.shape[:2], NO_PART, dtype=np.int8)
        left = 30 if stays else 5 * frame
        label[20:44, left : left + 12] = 0
        scene = np.roll(PLACE, tuple(rng.integers(-shake, shake + 1, size=2)), axis=(0, 1))
        image = np.where(label[..., None] == 0, RED, scene) + rng.normal(0.0, 3.0, size=PLACE.shape)
        images.append(np.clip(image, 0, 255).astype(np.uint8))
        labels.append(label)
    return learn_appearance(images, labels, 1)


def test_the_background_is_what_shows_when_nobody_is_before_it() -> None:
    learned = walk_by()
    assert learned.steady
    assert learned.known.all()
    assert np.abs(learned.color - PLACE).max() < 8.0


def test_what_a_performer_who_stays_hides_is_not_known() -> None:
    learned = walk_by(stays=True)
    assert not learned.known[25:40, 32:40].any()
    assert learned.known[:, :20].all()


@pytest.mark.parametrize("shake", [2, 6])
def test_a_shaken_camera_has_no_steady_background(shake: int) -> None:
    assert not walk_by(shake).steady


def test_colors_are_likelier_as_what_they_are() -> None:
    learned = walk_by()
    part, row, column = np.array(0), np.array(5), np.array(5)
    red, usual = RED.astype(np.uint8), PLACE[5, 5].astype(np.uint8)
    shaded = (0.8 * PLACE[5, 5]).astype(np.uint8)
    assert learned.part(part, red) > learned.background(row, column, red) + 3.0
    assert learned.part(part, usual) < learned.background(row, column, usual) - 3.0
    assert learned.part(part, shaded) < learned.background(row, column, shaded) - 3.0


@pytest.mark.parametrize("frames", [1, 2, 5, 12, 31, 32])
def test_the_usual_color_is_the_lower_median_of_what_is_free(frames: int) -> None:
    rng = np.random.default_rng(frames)
    images = rng.integers(0, 255, size=(frames, 8, 64, 3), dtype=np.uint8)
    labels = np.full((frames, 8, 64), NO_PART, dtype=np.int8)
    labels[0, :, :20] = 0
    learned = learn_appearance(list(images), list(labels), 1)
    for column, free in ((5, images[1:]), (50, images)):
        if len(free):
            expected = np.sort(free[:, 3, column], axis=0)[(len(free) - 1) // 2]
            np.testing.assert_array_equal(learned.color[3, column], expected)


def test_only_pixels_that_move_are_left_out() -> None:
    assert walk_by().where_steady().known.mean() > 0.95
    assert walk_by(6).where_steady().known.mean() < 0.5


SLEEVE, SKIN = np.array([180, 60, 40], dtype=np.uint8), np.array([120, 150, 210], dtype=np.uint8)


def learn() -> BandColors:
    image = np.full((40, 60, 3), 90, dtype=np.uint8)
    label = np.full((40, 60), -1, dtype=np.int8)
    share = np.full((40, 60), np.nan)
    for part, top in enumerate((5, 22)):
        label[top : top + 10] = part
        share[top : top + 10] = np.linspace(-0.1, 1.1, 60)
        image[top : top + 10] = np.where((share[top, :, None] < 2 / 3), SLEEVE, SKIN)
    return learn_band_colors([image], [label], [share], 2)


def test_each_band_has_the_colors_worn_there() -> None:
    bands = learn().bands[0]
    sleeve, skin = bands[:, band_cells(SLEEVE)], bands[:, band_cells(SKIN)]
    assert (sleeve[: 2 * BANDS // 3] > skin[: 2 * BANDS // 3] + 0.5).all()
    assert (skin[2 * BANDS // 3 :] > sleeve[2 * BANDS // 3 :] + 0.5).all()


def test_the_markers_are_among_the_strong_colors() -> None:
    found = strong_colors(drawn_frames(true_postures(6)))
    assert len(COLORS) <= len(found) <= 12
    colors = np.array([color.color_srgb for color in found], dtype=float)
    chroma = chromaticity(colors[:, ::-1])[0]
    for name, color in COLORS.items():
        wanted = chromaticity(np.array(color, dtype=float)[::-1])[0]
        assert np.linalg.norm(chroma - wanted, axis=1).min() < 0.08, name
    apart = np.linalg.norm(chroma[:, None] - chroma[None], axis=-1)[np.triu_indices(len(found), 1)]
    assert apart.min() > 0.03 and all(0.0 < color.share < 0.1 for color in found)
