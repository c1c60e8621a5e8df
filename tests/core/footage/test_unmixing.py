"""Unmixing of blurred and half-hidden surfaces, in small painted pictures."""

import cv2
import numpy as np
import pytest
from keymark.core.footage.segmentation.moments import centroid_and_second_moment
from keymark.core.footage.segmentation.unmixing import (
    MOST_GAIN,
    Palette,
    Surface,
    Traces,
    contrast,
    surface_of,
    traces,
)

WALL = np.array([150.0, 165.0, 160.0])
RED, GREEN, SKIN = (np.array(color, dtype=float) for color in ((45, 40, 215), (60, 140, 50), (140, 165, 215)))
SIZE, NOISE, FINER = 60, 2.0, 4
SIGNIFICANT = 10.0
DEVIATION = np.full((SIZE, SIZE), NOISE, dtype=np.float32)


def surface(color: np.ndarray) -> Surface:
    return Surface(contrast(color), 5.0)


PALETTE = Palette(surface(RED), (surface(GREEN), surface(SKIN)))


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
    found = look(swept(26.0 - width / 2, 26.0 + width / 2, RED))
    assert len(found.gain) == 1 and found.gain[0] > SIGNIFICANT
    centroid, second = centroid_and_second_moment(found.moments)
    np.testing.assert_allclose(centroid[0], (29.0, 30.0), atol=0.5)
    assert found.moments[0, 0] == pytest.approx(6 * 24, rel=1 / 6)
    assert second[0, 0, 0] == pytest.approx((6**2 + width**2) / 12, rel=0.25)
    assert second[0, 1, 1] == pytest.approx(24**2 / 12, rel=0.1)


def test_the_wider_the_blur_the_smaller_the_share() -> None:
    sharp, blurred = look(swept(26.0, 26.0, RED)), look(swept(20.0, 32.0, RED))
    assert sharp.peak[0] > 0.9 > 0.65 > blurred.peak[0] > 0.35
    assert 0.0 < sharp.certainty[0] <= 1.0 and sharp.gain[0] <= MOST_GAIN * SIZE**2


@pytest.mark.parametrize("seed", range(8))
def test_noise_is_no_surface(seed: int) -> None:
    assert look(wall(), seed).gain.max(initial=0.0) < 0.1 * SIGNIFICANT


def test_a_shadow_is_no_surface() -> None:
    shaded = wall()
    shaded[20:40, 15:45] *= 0.6
    assert look(shaded).gain.max(initial=0.0) < 0.1 * SIGNIFICANT


@pytest.mark.parametrize("color", [GREEN, SKIN])
@pytest.mark.parametrize("width", [0.0, 10.0])
def test_another_surface_is_another_blurred_or_not(color: np.ndarray, width: float) -> None:
    assert look(swept(20.0, 20.0 + width, color)).gain.max(initial=0.0) < SIGNIFICANT
    alone = Palette(surface(RED), ())
    if color is SKIN:
        assert (
            look(swept(20.0, 20.0, color), palette=alone).gain.max() > SIGNIFICANT
        )  # what the others prevent


def test_a_sliver_before_another_surface_is_found() -> None:
    hidden = bar(28.0, GREEN, bar(26.0, RED, wall()))
    found = look(hidden)
    best = int(found.gain.argmax())
    centroid, _ = centroid_and_second_moment(found.moments)
    assert found.gain[best] > SIGNIFICANT
    np.testing.assert_allclose(centroid[best], (27.0, 30.0), atol=0.7)


def test_an_unknown_background_tells_nothing() -> None:
    seen = bar(26.0, RED, wall()).astype(np.uint8)
    assert PALETTE.unmix(seen, wall().astype(np.float32), DEVIATION).gain.any()
    nothing = np.full(seen.shape, np.nan, dtype=np.float32)
    assert not PALETTE.unmix(seen, nothing, DEVIATION).gain.any()


def test_a_surface_is_the_usual_color_of_its_pixels() -> None:
    rng = np.random.default_rng(3)
    pixels = np.clip(RED + rng.normal(0.0, 4.0, (200, 3)), 0, 255).astype(np.uint8)
    pixels[:20] = WALL.astype(np.uint8)
    learned = surface_of(pixels)
    np.testing.assert_allclose(learned.color, contrast(RED), atol=1.5)
    assert learned.deviation < 6.0
