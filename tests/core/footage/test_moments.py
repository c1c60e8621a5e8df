"""Moments of shapes whose moments are known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.footage.segmentation.moments import (
    axis_angle_difference,
    centroid_and_second_moment,
    characteristics,
)


def raw_moments(weights: np.ndarray) -> np.ndarray:
    """Eq. 1 for pixels that are unit squares of even weight."""
    x, y = np.meshgrid(np.arange(weights.shape[1]) + 0.5, np.arange(weights.shape[0]) + 0.5)
    own = 1.0 / 12.0
    return np.array([np.sum(weights * of) for of in (1.0, x, y, x * x + own, x * y, y * y + own)])


def measured(mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return centroid_and_second_moment(raw_moments(mask))


def ellipse(angle: float, a: float = 60.0, b: float = 24.0, size: int = 160) -> np.ndarray:
    """An ellipse with soft edges, 8 x 8 points a pixel; `angle` from x towards y downwards."""
    fine = (np.arange(size * 8) + 0.5) / 8 - size / 2
    x, y = np.meshgrid(fine, fine)
    along, across = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
    inside = ((along / a) ** 2 + (across / b) ** 2 <= 1.0).astype(np.float64)
    return inside.reshape(size, 8, size, 8).mean(axis=(1, 3))


def test_a_rectangle_of_whole_pixels_has_exactly_the_rectangles_moments() -> None:
    mask = np.zeros((20, 30), dtype=bool)
    mask[4:10, 10:14] = True
    centroid, second = measured(mask)
    np.testing.assert_allclose(centroid, [12.0, 7.0])
    np.testing.assert_allclose(second, [[16 / 12, 0.0], [0.0, 3.0]], atol=1e-12)


@pytest.mark.parametrize("angle", np.linspace(-1.5, 1.5, 7))
def test_an_ellipse_gives_its_angle_and_the_square_of_its_axes_ratio(angle: float) -> None:
    found = characteristics(*measured(ellipse(angle)))
    assert found.x == pytest.approx(80.0) and found.y == pytest.approx(80.0)
    assert axis_angle_difference(found.angle_rad, angle) == pytest.approx(0.0, abs=2e-3)
    assert found.ratio == pytest.approx((60 / 24) ** 2, rel=5e-3)
    _, second = measured(ellipse(angle))
    np.testing.assert_allclose(np.linalg.eigvalsh(second), [24**2 / 4, 60**2 / 4], rtol=5e-3)


def test_an_empty_region_is_not_a_number() -> None:
    centroid, second = measured(np.zeros((5, 5)))
    assert np.isnan(centroid).all() and np.isnan(second).all()


@given(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0))
def test_axis_angles_differ_by_less_than_a_right_angle(first: float, second: float) -> None:
    difference = axis_angle_difference(first, second)
    assert -np.pi / 2 <= difference <= np.pi / 2
    assert np.sin(difference - (first - second)) == pytest.approx(0.0, abs=1e-9)


@given(st.floats(-1.5, 1.5), st.floats(0.5, 50.0), st.floats(1.05, 400.0))
def test_characteristics_recover_the_axes_a_matrix_was_made_of(
    angle: float, smaller: float, ratio: float
) -> None:
    """Also for long thin regions, where the smaller eigenvalue is easily lost in rounding."""
    axis = np.array([np.cos(angle), np.sin(angle)])
    normal = np.array([-axis[1], axis[0]])
    matrix = smaller * ratio * np.outer(axis, axis) + smaller * np.outer(normal, normal)
    found = characteristics([1.0, 2.0], matrix)
    assert axis_angle_difference(found.angle_rad, angle) == pytest.approx(0.0, abs=1e-6)
    assert found.ratio == pytest.approx(ratio, rel=1e-6)
