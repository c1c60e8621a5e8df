"""Where markers are searched first: around those of the interpolated keyframes, wider far from a keyframe."""

from dataclasses import replace

import numpy as np
import pytest
from _synthetic_take import write_synthetic_take
from keymark.core.prior.keyframes import interpolate
from keymark.core.take.read_footage import average_model, expected_regions
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

FRAMES, AFTER = 60, 11
"""Frames of the clip, and how many of them follow the last keyframe."""


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("expected") / "take", FRAMES - AFTER, 24))


def radius_m(take: Take) -> np.ndarray:
    """(F,) the radius at the performer's distance, alike for all markers [m]."""
    radius = expected_regions(take, FRAMES).radius
    assert radius.shape == (FRAMES, 5) and (np.ptp(radius, axis=1) == 0.0).all()
    prior = interpolate(take.keyframes, FRAMES)
    depth = take.camera.depth(prior.translation, np.arange(FRAMES))
    return np.asarray(radius[:, 0] * depth / take.camera.focal_px)


def test_near_a_keyframe_markers_are_searched_within_0_45_m(take: Take) -> None:
    assert take.keyframe_indices == (0, 24, 48)
    near = [*range(7), *range(18, 31), *range(42, 55)]
    np.testing.assert_allclose(radius_m(take)[near], 0.45, atol=1e-3)


def test_farther_from_it_the_radius_grows_with_a_limb_s_speed(take: Take) -> None:
    found = radius_m(take)
    np.testing.assert_allclose(found[[9, 15]], 0.45 + 3.0 * 0.1, atol=1e-3)
    np.testing.assert_allclose(found[[12, 36]], 0.45 + 3.0 * 0.2, atol=1e-3)
    np.testing.assert_allclose(np.diff(found[54:]), 0.1, atol=1e-3)


def test_time_counts_and_not_frames(take: Take) -> None:
    np.testing.assert_allclose(radius_m(replace(take, fps=60.0))[12], 0.45, atol=1e-3)


def test_markers_are_expected_where_the_interpolated_keyframes_have_them(take: Take) -> None:
    center = expected_regions(take, FRAMES).center
    prior = interpolate(take.keyframes, FRAMES)
    model = average_model(take)
    expected = model.evaluate(take.body.pose(prior), np.arange(FRAMES)).centroid
    assert np.abs(center - expected).max() <= 1.0 / 128.0
    np.testing.assert_array_equal(center[49:], np.broadcast_to(center[48], center[49:].shape))
