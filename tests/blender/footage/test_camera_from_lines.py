"""The camera from lines: how a mouse draws them, and what the take's camera becomes."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from keymark.core.camera.camera import Camera
from keymark.core.camera.camera_fields import CameraPlacement
from keymark.operators.footage.found_camera import (
    ACROSS,
    HEIGHT,
    LEVEL,
    VERTICAL,
    Drawing,
    DrawnLine,
    Pixel,
    read_lines,
    store_lines,
)
from keymark.operators.footage.load_footage import lens_is_guess
from keymark.operators.shell.take_state import TakeState

pytestmark = pytest.mark.usefixtures("registered")
SIZE = (160, 120)
SCALE = 10.0  # Region pixels within which an end is taken, and of a footage pixel


def known_camera() -> Camera:
    return Camera(40.8, 36.0, SIZE, CameraPlacement(1.1, float(np.radians(-9.0)), 0.0).matrix())


def seen_lines(camera: Camera, stature_m: float) -> list[DrawnLine]:
    """Two door frames, two lines on the floor and the performer, as they are seen in the clip."""
    ends = {
        VERTICAL: [[[x, 5.0, 0.1], [x, 5.0, 2.0]] for x in (-1.0, 1.3)],
        LEVEL: [[[x, 4.0, 0.0], [x, 7.0, 0.0]] for x in (-0.8, 0.9)],
        HEIGHT: [[[0.0, 5.0, 0.0], [0.0, 5.0, stature_m]]],
    }
    return [
        DrawnLine(kind, [tuple(map(float, pixel)) for pixel in camera.project(line)[0]], 1)
        for kind, group in ends.items()
        for line in np.array(group)
    ]


def test_lines_set_the_camera_and_are_kept(loaded: bpy.types.PropertyGroup) -> None:
    lines = seen_lines(known_camera(), loaded.stature)
    place = tuple(loaded.camera.location[:2])
    store_lines(loaded, lines)
    assert [(line.kind, line.frame) for line in read_lines(loaded)] == [(line.kind, 1) for line in lines]
    assert bpy.ops.keymark.camera_from_lines() == {"FINISHED"}
    assert loaded.camera_height == pytest.approx(1.1, abs=0.05)
    assert np.degrees(loaded.camera_tilt) == pytest.approx(-9.0, abs=0.7)
    assert np.degrees(loaded.camera_roll) == pytest.approx(0.0, abs=0.2)
    assert tuple(loaded.camera.location[:2]) == pytest.approx(place)
    assert not TakeState(loaded).placement_is_guess and "tilt ±" in loaded.camera_findings
    assert lens_is_guess(loaded) and "Lens is kept" in loaded.camera_findings
    loaded.camera_height = 1.2
    assert loaded.camera_findings == ""  # what was entered is not what was found


def test_a_lens_that_lines_determine_is_no_guess(loaded: bpy.types.PropertyGroup) -> None:
    true = replace(
        known_camera(),
        lens_mm=28.0,
        matrix_world=CameraPlacement(2.4, float(np.radians(-28.0)), 0.0).matrix(),
    )
    store_lines(loaded, 20 * seen_lines(true, loaded.stature))
    bpy.ops.keymark.camera_from_lines()
    assert loaded.camera.data.lens == pytest.approx(28.0, abs=1.0) and not lens_is_guess(loaded)


def test_a_lens_that_somebody_knows_is_kept(loaded: bpy.types.PropertyGroup) -> None:
    loaded.camera.data.lens = 33.0
    store_lines(loaded, 20 * seen_lines(known_camera(), loaded.stature))
    bpy.ops.keymark.camera_from_lines()
    assert loaded.camera.data.lens == pytest.approx(33.0)
    assert "Lens" not in loaded.camera_findings


def test_the_sensors_fit_does_not_matter(loaded: bpy.types.PropertyGroup) -> None:
    data = loaded.camera.data
    data.sensor_fit, data.sensor_height = "VERTICAL", 24.0
    data.lens = 40.8 / 36.0 * 24.0 * 160 / 120
    loaded.guessed_lens_mm = data.lens
    store_lines(loaded, 20 * seen_lines(replace(known_camera(), lens_mm=36.0), loaded.stature))
    bpy.ops.keymark.camera_from_lines()
    assert data.lens * 120 / 160 / 24.0 == pytest.approx(1.0, abs=0.06)


def test_without_lines_or_with_useless_ones_nothing_changes(loaded: bpy.types.PropertyGroup) -> None:
    before = tuple(loaded.guessed_placement)
    with pytest.raises(RuntimeError, match="no lines to find its camera by"):
        bpy.ops.keymark.camera_from_lines()
    store_lines(loaded, [DrawnLine(LEVEL, [(10.0, 10.0), (12.0, 10.0)], 1)])
    with pytest.raises(RuntimeError, match="says nothing of its camera yet"):
        bpy.ops.keymark.camera_from_lines()
    assert TakeState(loaded).placement_is_guess and tuple(loaded.guessed_placement) == before


def near(pixel: Pixel) -> "object":
    """Distance from a mouse at a pixel, as a share of the largest at which an end is taken."""
    return lambda other: float(np.hypot(pixel[0] - other[0], pixel[1] - other[1])) / SCALE


def far(one: Pixel, other: Pixel) -> float:
    return float(np.hypot(one[0] - other[0], one[1] - other[1])) / SCALE


def drag(drawing: Drawing, start: Pixel, end: Pixel) -> None:
    drawing.press(start, 3, near(start))
    drawing.move(end)
    drawing.release(far)


def test_five_drags_draw_five_lines_of_three_kinds() -> None:
    drawing = Drawing(VERTICAL, False)
    for number in range(5):
        drag(drawing, (100.0 * number, 10.0), (100.0 * number, 200.0))
    kinds = [line.kind for line in drawing.lines]
    assert kinds == [VERTICAL, VERTICAL, LEVEL, LEVEL, HEIGHT] and drawing.kind == HEIGHT
    drawing.next_kind()
    assert drawing.kind == VERTICAL
    drag(drawing, (600.0, 10.0), (600.0, 200.0))
    assert drawing.kind == VERTICAL and drawing.lines[-1].kind == VERTICAL  # chosen: it stays
    drawing.next_kind()
    drawing.next_kind()
    assert drawing.kind == ACROSS


def test_two_clicks_draw_a_line_as_well() -> None:
    drawing = Drawing(HEIGHT, True)
    drawing.press((50.0, 300.0), 7, near((50.0, 300.0)))
    assert not drawing.release(far) and drawing.complete == []
    drawing.move((55.0, 100.0))
    assert len(drawing.complete) == 1
    drawing.press((55.0, 90.0), 7, near((55.0, 90.0)))
    assert drawing.release(far) and drawing.held is None
    assert drawing.lines == [DrawnLine(HEIGHT, [(50.0, 300.0), (55.0, 90.0)], 7)]


def test_an_end_is_dragged_and_a_line_removed() -> None:
    drawing = Drawing(VERTICAL, False)
    drag(drawing, (10.0, 10.0), (10.0, 200.0))
    drag(drawing, (90.0, 10.0), (90.0, 200.0))
    drag(drawing, (12.0, 203.0), (30.0, 210.0))
    assert [line.ends[1] for line in drawing.lines] == [(30.0, 210.0), (90.0, 200.0)]
    drawing.remove(lambda line: 0.5 if line.ends[0][0] == 10.0 else 9.0)
    assert [line.ends[0] for line in drawing.lines] == [(90.0, 10.0)]
    drawing.remove(lambda line: 9.0)
    drawing.remove(lambda line: 9.0)
    assert drawing.lines == []


def test_digits_give_the_last_height_its_length() -> None:
    drawing = Drawing(HEIGHT, False, stature_m=1.75)
    drag(drawing, (10.0, 10.0), (10.0, 200.0))
    assert drawing.length_of(drawing.lines[0]) == 1.75
    for letter in "2.05\b":
        assert drawing.type(letter)
    assert drawing.lines[0].length == pytest.approx(2.0)
    performer = Drawing(HEIGHT, True, stature_m=1.75, of_performer=True)
    drag(performer, (10.0, 10.0), (10.0, 200.0))
    for letter in "1.62":
        performer.type(letter)
    assert performer.stature_m == pytest.approx(1.62) and performer.lines[0].length == 0.0
    plumb = Drawing(VERTICAL, False)
    drag(plumb, (10.0, 10.0), (10.0, 200.0))
    assert not plumb.type("1")
