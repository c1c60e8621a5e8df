"""Paths out of values whose errors wander: smoothed as much as they need, exact where they are known."""

import numpy as np
import pytest
from _elsewhere import jitter_mm, seen_by_network
from keymark.core.numerics.wandering import learn_sizes, smooth_path

TIME_S = np.arange(150) / 30.0


def swinging(hertz: float) -> np.ndarray:
    """(F, 4, 3) points that swing by 20 cm."""
    phases = np.arange(12).reshape(4, 3)
    return 0.2 * np.sin(2.0 * np.pi * hertz * TIME_S[:, None, None] + phases)


def smoothed(values: np.ndarray) -> np.ndarray:
    sizes = learn_sizes(values, 30.0)
    return np.stack([smooth_path(values[:, point], sizes) for point in range(values.shape[1])], axis=1)


@pytest.mark.parametrize("hertz", [0.2, 1.0, 2.5])
def test_what_swings_slowly_is_smoothed_more(hertz: float) -> None:
    truth = swinging(hertz)
    given = seen_by_network(truth, place_m=0.0)
    path = smoothed(given)
    assert jitter_mm(path) < 1.5 * jitter_mm(truth) + 1.0
    assert jitter_mm(given) > 25.0
    assert np.abs(path - truth).mean() < 1.02 * np.abs(given - truth).mean()


def test_sizes_do_not_depend_on_units_and_hardly_on_frames_left_out() -> None:
    given = seen_by_network(swinging(1.0))
    sizes = learn_sizes(given, 30.0)
    assert learn_sizes(100.0 * given, 30.0) == sizes
    given[::10] = np.nan
    assert abs(np.log10(learn_sizes(given, 30.0).bend / sizes.bend)) < 0.3


def test_missing_values_are_filled_and_leaping_ones_forgiven() -> None:
    truth = swinging(0.5)
    given = seen_by_network(truth, bias_m=0.005, place_m=0.0)
    given[40:46] = np.nan
    given[90] += 0.5
    path = smoothed(given)
    assert np.isfinite(path).all()
    assert np.abs(path[40:46] - truth[40:46]).max() < 0.05
    assert np.abs(path[90] - truth[90]).max() < 0.05


def test_an_exact_frame_is_met_and_tells_the_error_beside_it() -> None:
    truth = swinging(1.0)[:, 0]
    given = seen_by_network(truth[:, None], 3, bias_m=0.05, place_m=0.0)[:, 0]
    sizes = learn_sizes(given[:, None], 30.0)
    frames = np.array([30, 75, 120])
    plain = smooth_path(given, sizes)
    corrected = smooth_path(given, sizes, frames, truth[frames])
    np.testing.assert_allclose(corrected[frames], truth[frames], atol=2e-3)
    beside = np.unique(frames[:, None] + np.arange(-6, 7))
    error = [np.linalg.norm(path - truth, axis=1) for path in (plain, corrected)]
    assert error[1][beside].mean() < 0.75 * error[0][beside].mean()
    assert error[1].mean() < error[0].mean()
