"""Footage pixels in the Movie Clip editor and in the camera view."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from keymark.core.camera.camera import Camera
from keymark.operators.shell.footage_view import FootageView, footage_view

PIXELS = np.array([[0.0, 0.0], [160.0, 0.0], [80.5, 31.25]])


def view(lens: Camera | None) -> FootageView:
    """A region that shows 160 x 120 pixels twice as large, its top left corner at (10, 300)."""
    return FootageView(
        SimpleNamespace(), (160, 120), np.array([10.0, 300.0]), np.array([320.0, -240.0]), lens
    )


def test_the_corners_of_the_picture_lie_where_the_region_shows_them() -> None:
    expected = np.array([[10.0, 300.0], [330.0, 300.0], [171.0, 237.5]])
    assert view(None).to_region(PIXELS) == pytest.approx(expected)


@pytest.mark.parametrize("distortion", [(0.0, 0.0, 0.0), (-0.2, 0.05, 0.0)])
def test_there_and_back(camera: Camera, distortion: tuple[float, float, float]) -> None:
    lens = replace(camera, matrix_world=np.eye(4), distortion=distortion)
    shown = view(lens)
    assert shown.to_footage(shown.to_region(PIXELS)) == pytest.approx(PIXELS, abs=0.01)


def test_a_point_is_found_where_the_lens_put_it(camera: Camera) -> None:
    lens = replace(camera, matrix_world=np.eye(4), distortion=(-0.2, 0.05, 0.0), shift_x=0.05)
    point = np.array([1.2, 0.8, -3.0])
    recorded, _ = lens.project(point)
    straight, _ = replace(lens, distortion=(0.0, 0.0, 0.0)).project(point)
    assert np.abs(recorded - straight).max() > 0.5
    assert view(lens).to_region(recorded) == pytest.approx(view(None).to_region(straight), abs=0.02)


def test_no_editor_shows_footage_whose_file_is_missing() -> None:
    clip = SimpleNamespace(size=(256, 256))
    space = SimpleNamespace(clip=clip, view="CLIP")
    area = SimpleNamespace(type="CLIP_EDITOR", spaces=SimpleNamespace(active=space))
    take = SimpleNamespace(clip=clip, clip_state=SimpleNamespace(missing=True))
    assert footage_view(SimpleNamespace(), take, area, SimpleNamespace(type="WINDOW")) is None
