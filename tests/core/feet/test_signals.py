"""Signals over time: corrections that fade, smoothing that keeps ends, drops that suffice."""

import numpy as np
from keymark.core.feet.fading import FADE_S, Hold, faded, smooth_above, smoothed

TIME_S = np.arange(120) / 30.0


def test_a_correction_holds_and_fades_without_a_jump_in_speed() -> None:
    inside = np.linspace([0.02, 0.0, 0.0], [0.03, 0.01, 0.0], 20)
    offset = faded([Hold(50, inside)], TIME_S)
    np.testing.assert_array_equal(offset[50:70], inside)
    far = np.abs(TIME_S - 0.5 * (TIME_S[50] + TIME_S[69])) > 0.5 * (TIME_S[69] - TIME_S[50]) + FADE_S
    assert not offset[far].any()
    assert np.abs(np.diff(offset, 2, axis=0)).max() < 0.004


def test_corrections_that_follow_closely_are_joined() -> None:
    holds = [Hold(10, np.full((20, 3), 0.01)), Hold(36, np.full((20, 3), 0.01))]
    np.testing.assert_allclose(faded(holds, TIME_S)[10:56], 0.01, atol=2e-3)


def test_nothing_held_is_nothing_changed() -> None:
    assert not faded([], TIME_S).any()
    np.testing.assert_array_equal(faded([Hold(0, np.ones((120, 3)))], TIME_S), np.ones((120, 3)))


def test_smoothing_keeps_lines_and_ends() -> None:
    line = np.linspace([0.0, 1.0], [2.0, -3.0], 120)
    np.testing.assert_allclose(smoothed(line, TIME_S, 0.3), line, atol=1e-9)
    noise = np.random.default_rng(5).normal(0.0, 0.1, (120, 2))
    assert (smoothed(line + noise, TIME_S, 0.3) - line).std() < 0.05


def test_smoothing_counts_in_seconds() -> None:
    uneven = np.sort(np.concatenate([TIME_S, TIME_S[40:60] + 0.017]))
    wave = np.sin(2.0 * uneven)
    even = smoothed(np.sin(2.0 * TIME_S), TIME_S, 0.2)
    np.testing.assert_allclose(smoothed(wave, uneven, 0.2), np.interp(uneven, TIME_S, even), atol=0.01)


def test_a_drop_is_smooth_and_enough() -> None:
    needed = np.zeros(120)
    needed[60:64] = 0.03
    drop = smooth_above(needed, TIME_S, 0.2)
    assert (drop >= needed - 1e-12).all()
    assert drop[:45].max() == 0.0
    assert np.abs(np.diff(drop)).max() < 0.008
