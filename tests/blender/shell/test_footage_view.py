"""Footage pixels in the Movie Clip editor and in the camera view; operators that wait for clicks on them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from keymark.core.camera.camera import Camera
from keymark.operators.shell import footage_view as shown
from keymark.operators.shell.footage_view import ClickSequence, FootageView, footage_view

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


class Clicks(ClickSequence):
    """A tool that notes what it is told."""

    def __init__(self) -> None:
        self.noted: list[object] = []
        for name in ("ask", "cancel", "go_on", "go_back"):
            setattr(self, name, lambda _context, name=name: self.noted.append(name))

    def clicked(self, context: SimpleNamespace, pixel: tuple[float, float]) -> set[str]:
        self.noted.append(pixel)
        return super().clicked(context, pixel)


RUNS, PASSES, ENDS = {"RUNNING_MODAL"}, {"PASS_THROUGH"}, {"CANCELLED"}


@pytest.mark.parametrize(
    ("kind", "place", "noted", "result"),
    [
        ("LEFTMOUSE", (20, 30), [(20, 30)], RUNS),
        ("LEFTMOUSE", (300, 30), [], PASSES),  # the time line
        ("LEFTMOUSE", (500, 30), ["cancel"], ENDS | PASSES),
        ("TAB", (20, 30), ["go_on", "ask"], RUNS),
        ("BACK_SPACE", (20, 30), ["go_back", "ask"], RUNS),
        ("RET", (20, 30), ["cancel"], ENDS),
        ("ESC", (20, 30), ["cancel"], ENDS),
        ("RIGHTMOUSE", (20, 30), ["cancel"], ENDS),
        ("RIGHT_ARROW", (20, 30), [], PASSES),
        ("A", (20, 30), [], RUNS),
    ],
)
def test_clicks_are_taken_until_enter_or_one_beside_the_footage(
    monkeypatch: pytest.MonkeyPatch, kind: str, place: tuple[int, int], noted: list[object], result: set[str]
) -> None:
    monkeypatch.setattr(shown, "active_take", lambda _scene: None)
    monkeypatch.setattr(shown, "pixel_under", lambda _context, _take, x, y: (x, y) if x < 200 else None)
    editor = SimpleNamespace(type="DOPESHEET_EDITOR", x=200, y=0, width=200, height=100)
    context = SimpleNamespace(scene=None, screen=SimpleNamespace(areas=[editor]))
    tool = Clicks()
    event = SimpleNamespace(type=kind, value="PRESS", mouse_x=place[0], mouse_y=place[1])
    assert tool.modal(context, event) == result and tool.noted == noted
    event.value = "RELEASE"
    assert tool.modal(context, event) == (PASSES if kind == "RIGHT_ARROW" else RUNS) and tool.noted == noted
