"""How surfaces look: colors of parts and bands, backgrounds, blurred and half-hidden surfaces."""

import cv2
import numpy as np
import pytest
from _synthetic_take import COLORS, drawn_frames, true_postures
from keymark.core.markers.appearance import NO_PART, Appearance, learn_appearance
from keymark.core.markers.color_model import chromaticity
from keymark.core.markers.moments import centroid_and_second_moment
from keymark.core.markers.strong_colors import strong_colors
from keymark.core.markers.surface_colors import BANDS, BandColors, band_cells, learn_band_colors
from keymark.core.markers.unmixing import MOST_GAIN, Palette, Surface, Traces, contrast, surface_of, traces

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


WALL = np.array([150.0, 165.0, 160.0])
CLOTH, GREEN, BARE = (
    np.array(color, dtype=float) for color in ((45, 40, 215), (60, 140, 50), (140, 165, 215))
)
SIZE, NOISE, FINER = 60, 2.0, 4
SIGNIFICANT = 10.0
DEVIATION = np.full((SIZE, SIZE), NOISE, dtype=np.float32)


def surface(color: np.ndarray) -> Surface:
    return Surface(contrast(color), 5.0)


PALETTE = Palette(surface(CLOTH), (surface(GREEN), surface(BARE)))


def bar(left: float, color: np.ndarray, image: np.ndarray) -> np.ndarray:
    """A picture with an upright bar of 6 by 24 pixels painted over it, its left edge at `left`."""
    fine = np.kron(image, np.ones((FINER, FINER, 1)))
    fine[18 * FINER : 42 * FINER, round(left * FINER) : round((left + 6.0) * FINER)] = color
    return cv2.resize(fine, (SIZE, SIZE), interpolation=cv2.INTER_AREA)


def wall() -> np.ndarray:
    return WALL * np.linspace(0.9, 1.1, SIZE)[None, :, None] * np.ones((SIZE, 1, 1))


def look(image: np.ndarray, seed: int = 0, palette: Palette = PALETTE) -> Traces:
    """What is found in a noisy, smoothed picture before the known wall."""
    noisy = image + np.random.default_rng(seed).normal(0.0, NOISE, image.shape)
    seen = cv2.GaussianBlur(np.clip(np.round(noisy), 0, 255).astype(np.uint8), (3, 3), 0.0)
    return traces(palette.unmix(seen, wall().astype(np.float32), DEVIATION), (0, 0))


def swept(first: float, last: float, color: np.ndarray) -> np.ndarray:
    """A bar that moves from one place to another while the shutter is open."""
    return np.mean([bar(left, color, wall()) for left in np.linspace(first, last, 17)], axis=0)


@pytest.mark.parametrize("width", [0.0, 6.0, 12.0])
def test_a_bar_is_found_where_it_was_on_average(width: float) -> None:
    found = look(swept(26.0 - width / 2, 26.0 + width / 2, CLOTH))
    assert len(found.gain) == 1 and found.gain[0] > SIGNIFICANT
    centroid, second = centroid_and_second_moment(found.moments)
    np.testing.assert_allclose(centroid[0], (29.0, 30.0), atol=0.5)
    assert found.moments[0, 0] == pytest.approx(6 * 24, rel=1 / 6)
    assert second[0, 0, 0] == pytest.approx((6**2 + width**2) / 12, rel=0.25)
    assert second[0, 1, 1] == pytest.approx(24**2 / 12, rel=0.1)


def test_the_wider_the_blur_the_smaller_the_share() -> None:
    sharp, blurred = look(swept(26.0, 26.0, CLOTH)), look(swept(20.0, 32.0, CLOTH))
    assert sharp.peak[0] > 0.9 > 0.65 > blurred.peak[0] > 0.35
    assert 0.0 < sharp.certainty[0] <= 1.0 and sharp.gain[0] <= MOST_GAIN * SIZE**2


@pytest.mark.parametrize("seed", range(8))
def test_noise_is_no_surface(seed: int) -> None:
    assert look(wall(), seed).gain.max(initial=0.0) < 0.1 * SIGNIFICANT


def test_a_shadow_is_no_surface() -> None:
    shaded = wall()
    shaded[20:40, 15:45] *= 0.6
    assert look(shaded).gain.max(initial=0.0) < 0.1 * SIGNIFICANT


@pytest.mark.parametrize("color", [GREEN, BARE])
@pytest.mark.parametrize("width", [0.0, 10.0])
def test_another_surface_is_another_blurred_or_not(color: np.ndarray, width: float) -> None:
    assert look(swept(20.0, 20.0 + width, color)).gain.max(initial=0.0) < SIGNIFICANT
    alone = Palette(surface(CLOTH), ())
    if color is BARE:
        assert (
            look(swept(20.0, 20.0, color), palette=alone).gain.max() > SIGNIFICANT
        )  # what the others prevent


def test_a_sliver_before_another_surface_is_found() -> None:
    hidden = bar(28.0, GREEN, bar(26.0, CLOTH, wall()))
    found = look(hidden)
    best = int(found.gain.argmax())
    centroid, _ = centroid_and_second_moment(found.moments)
    assert found.gain[best] > SIGNIFICANT
    np.testing.assert_allclose(centroid[best], (27.0, 30.0), atol=0.7)


def test_an_unknown_background_tells_nothing() -> None:
    seen = bar(26.0, CLOTH, wall()).astype(np.uint8)
    assert PALETTE.unmix(seen, wall().astype(np.float32), DEVIATION).gain.any()
    nothing = np.full(seen.shape, np.nan, dtype=np.float32)
    assert not PALETTE.unmix(seen, nothing, DEVIATION).gain.any()


def test_a_surface_is_the_usual_color_of_its_pixels() -> None:
    rng = np.random.default_rng(3)
    pixels = np.clip(CLOTH + rng.normal(0.0, 4.0, (200, 3)), 0, 255).astype(np.uint8)
    pixels[:20] = WALL.astype(np.uint8)
    learned = surface_of(pixels)
    np.testing.assert_allclose(learned.color, contrast(CLOTH), atol=1.5)
    assert learned.deviation < 6.0
