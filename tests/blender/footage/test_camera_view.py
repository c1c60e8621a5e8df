"""The footage in a viewport: all of it beside the sidebar, unless a person has moved the view."""

from math import sqrt
from types import SimpleNamespace

import pytest
from keymark.operators.footage.camera_view import (
    camera_view,
    free_box,
    is_same,
    may_move,
    picture_at_factor_one,
)

pytestmark = pytest.mark.usefixtures("registered")
REGION = (1000, 600)


def region(kind: str, x: int, y: int, width: int, height: int) -> SimpleNamespace:
    return SimpleNamespace(type=kind, x=x, y=y, width=width, height=height)


def test_panels_take_their_room() -> None:
    window = region("WINDOW", 100, 50, *REGION)
    sidebar, tools = region("UI", 850, 50, 250, 600), region("TOOLS", 100, 50, 40, 600)
    header, beside = region("HEADER", 100, 620, 1000, 30), region("UI", 1100, 50, 200, 600)
    assert free_box(SimpleNamespace(regions=[window, sidebar, tools, header]), window) == (40, 0, 750, 570)
    assert free_box(SimpleNamespace(regions=[window, beside, region("UI", 1099, 50, 1, 1)]), window) == (
        *(0, 0),
        *REGION,
    )
    wide = region("UI", 200, 50, 900, 600)
    assert free_box(SimpleNamespace(regions=[window, wide]), window) == (0, 0, *REGION)


@pytest.mark.parametrize("picture", [(1920.0, 1080.0), (1080.0, 1920.0), (960.0, 912.0)])
@pytest.mark.parametrize("sensor_fit", ["HORIZONTAL", "VERTICAL", "AUTO"])
def test_the_picture_fills_the_free_part(picture: tuple[float, float], sensor_fit: str) -> None:
    free = (40.0, 0.0, 750.0, 570.0)
    whole = picture_at_factor_one(REGION, picture, sensor_fit)
    zoom, offset = camera_view(REGION, free, whole)
    factor = ((sqrt(2.0) + zoom / 50.0) / 2.0) ** 2
    edges = []
    for axis in (0, 1):
        center = 0.5 * REGION[axis] - 2.0 * factor * offset[axis] * REGION[axis]
        half = 0.5 * factor * whole[axis]
        edges.append((center - half - free[axis], free[axis + 2] - center - half))
    assert min(min(pair) for pair in edges) == pytest.approx(12.0)
    assert all(pair[0] == pytest.approx(pair[1]) for pair in edges)


def test_a_view_that_a_person_has_moved_stays() -> None:
    fitted = (15.333744, 0.0502002, 0.0191536)
    assert may_move((15.3337440490, 0.0502002276, 0.0191536434), fitted)
    assert may_move((0.0, 0.0, 0.0), None) and may_move((8.0, 0.0, 0.0), fitted)
    assert not may_move((15.333744, 0.2, 0.1), fitted)
    assert not may_move((29.0, 0.0502002, 0.0191536), fitted)
    assert not may_move(fitted, None)
    assert is_same(fitted, (15.3337440490, 0.0502002276, 0.0191536434))
