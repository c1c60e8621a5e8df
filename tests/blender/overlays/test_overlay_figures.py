"""The plane figures that overlays are made of, and the time that masks may take in playback."""

from types import SimpleNamespace

import numpy as np
import pytest
from keymark.operators.overlays.figures import circles, dashes, diamonds, segments, triangles
from keymark.operators.overlays.mask import LARGEST_SHARE, is_fast


def lengths(parts: np.ndarray) -> np.ndarray:
    return np.linalg.norm(parts[:, 1] - parts[:, 0], axis=-1)


def test_a_line_is_cut_at_places_that_are_missing() -> None:
    line = np.array([[0, 0], [1, 0], [np.nan, 0], [3, 0], [4, 1]])
    assert segments(line).tolist() == [[[0, 0], [1, 0]], [[3, 0], [4, 1]]]
    assert len(segments(line, closed=True)) == 3
    assert segments(np.zeros((5, 7, 3))).shape == (30, 2, 3)
    assert segments(np.empty((0, 2))).shape == (0, 2, 2)


def test_dashes_run_on_around_corners() -> None:
    corner = np.array([[0.0, 0.0], [7.0, 0.0], [7.0, 5.0]])
    parts = dashes(corner, 5.0, 4.0)
    assert parts.tolist() == [[[0, 0], [5, 0]], [[7, 2], [7, 5]]]
    around = dashes(corner, 6.0, 3.0)
    assert around.tolist() == [[[0, 0], [6, 0]], [[7, 2], [7, 5]]]
    across_corner = dashes(corner, 8.0, 1.0)
    assert across_corner.tolist() == [[[0, 0], [7, 0]], [[7, 0], [7, 1]], [[7, 2], [7, 5]]]


def test_dashes_of_a_closed_line_go_all_the_way_round() -> None:
    (ring,) = circles([[10.0, 10.0]], 50.0, 200)
    parts = dashes(ring, 6.0, 4.0, closed=True)
    assert lengths(parts).sum() == pytest.approx(0.6 * 2.0 * np.pi * 50.0, rel=0.02)
    assert np.linalg.norm(parts - 10.0, axis=-1) == pytest.approx(50.0, abs=0.05)


def test_dashes_are_bounded_in_number_however_long_the_line() -> None:
    parts = dashes([[0.0, 0.0], [1e9, 0.0]], 6.0, 4.0)
    assert 900 <= len(parts) <= 1001
    assert lengths(parts).sum() == pytest.approx(0.6e9, rel=1e-3)


@pytest.mark.parametrize(
    "line", [np.empty((0, 2)), [[1.0, 2.0]], [[1.0, 2.0], [1.0, 2.0]], [[np.nan, 0.0]] * 3]
)
def test_a_line_without_length_has_no_dashes(line: np.ndarray) -> None:
    assert dashes(line, 6.0, 4.0, closed=True).shape == (0, 2, 2)


def test_dashes_begin_anew_after_a_missing_place() -> None:
    line = np.array([[0.0, 0.0], [3.0, 0.0], [np.nan, np.nan], [10.0, 0.0], [20.0, 0.0]])
    assert dashes(line, 5.0, 2.0)[:, 0, 0].tolist() == [0.0, 10.0, 17.0]


def test_circles_and_diamonds_have_their_size() -> None:
    rings = circles([[0.0, 0.0], [5.0, 5.0]], [1.0, 3.0])
    assert np.linalg.norm(rings[1] - 5.0, axis=-1) == pytest.approx(3.0)
    assert diamonds([[2.0, 3.0]], 1.0)[0] == pytest.approx(np.array([[3, 3], [2, 4], [1, 3], [2, 2]]))


def test_triangles_cover_a_convex_polygon() -> None:
    (hexagon,) = circles([[0.0, 0.0]], 1.0, 6)
    parts = triangles([hexagon])
    edges = parts[:, 1:] - parts[:, :1]
    area = 0.5 * np.abs(edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0])
    assert area.sum() == pytest.approx(1.5 * np.sqrt(3.0))
    assert len(triangles([[[0, 0], [1, 0], [np.nan, 1], [0, 1]]])) == 0


@pytest.mark.parametrize("fps", [24, 60])
def test_masks_that_slow_playback_down_are_left_out(fps: int) -> None:
    scene = SimpleNamespace(render=SimpleNamespace(fps=fps, fps_base=1.001))
    costs = [share * LARGEST_SHARE * 1.001 / fps for share in (0.0, 0.5, 2.0)]
    assert [is_fast(cost, scene) for cost in costs] == [True, True, False]
