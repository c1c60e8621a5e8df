"""The camera of the session's first step: found from lines and from the performer, by mouse and keys."""

import bpy
import numpy as np
from driver import Steps, expect, turns
from numpy.typing import NDArray
from person import Person, keymark

AHEAD_M = 4.5
"""Distance over the floor at which the lines are that a person would see there."""
TILT_DEGREES, HEIGHT_M = 3.0, 0.2
"""How far the camera found may be from the true one, drawn to the pixel with a lens that is a guess."""


def find_camera(person: Person) -> Steps[None]:
    """Lines are asked for before markers, drawn, forgotten by Esc, taken by Enter, and undone by one step."""
    step = keymark("operators.takes.next_step").next_step
    expect("camera" in step(person.take), f"after loading, the next step is '{step(person.take)}'")
    yield from person.changes_nothing("forgetting lines", lambda: _draw(person, "ESC"))
    yield from person.undoable("finding the camera", lambda: _draw(person, "RET"))
    _expect_near(person)
    expect("camera" not in step(person.take), f"with the camera, the next step is '{step(person.take)}'")
    person.scene.keymark.overlays.show_floor_grid = True
    person.step_done("Show the floor")
    yield from person.look("camera")
    person.scene.keymark.overlays.show_floor_grid = False
    person.step_done("Hide the floor")


def _draw(person: Person, key: str) -> Steps[None]:
    """Draw two verticals, two lines on the floor and the performer's height, then press a key."""
    yield from person.hands.click_button("keymark.camera_from_lines", "kind='VERTICAL'")
    for start, end in _lines(person):
        yield from person.hands.drag(_place(person, start), _place(person, end))
    if key == "RET":
        yield from person.look("lines")
    yield from person.hands.press(key)
    yield from turns(3)
    expect(not person.jobs(), f"{key} does not end the lines")


def _lines(person: Person) -> NDArray[np.float64]:
    """(5, 2, 2) ends of lines in the footage [px] that lie in the world as the person knows."""
    known = person.known.camera
    heading = keymark("core.footage.camera_placement").heading_rad(known.matrix_world)
    ahead, right = (
        np.array([-np.sin(heading), np.cos(heading), 0.0]),
        np.array([np.cos(heading), np.sin(heading), 0]),
    )
    foot = known.matrix_world[:3, 3] * [1.0, 1.0, 0.0] + AHEAD_M * ahead
    up = np.array([0.0, 0.0, 1.0])
    stature = person.take.stature
    ends = np.array(
        [
            [foot - 0.9 * right + 0.1 * up, foot - 0.9 * right + 1.9 * up],
            [foot + right + 0.1 * up, foot + right + 1.9 * up],
            [foot - 0.7 * right - 0.5 * ahead, foot - 0.7 * right + 1.5 * ahead],
            [foot + 0.8 * right - 0.5 * ahead, foot + 0.8 * right + 1.5 * ahead],
            [foot, foot + stature * up],
        ]
    )
    pixel: NDArray[np.float64] = known.project(ends)[0]
    return pixel


def _place(person: Person, pixel: NDArray[np.float64]) -> tuple[float, float]:
    """Where a pixel of the footage is in the window."""
    area, region = person.hands.area("VIEW_3D"), person.hands.region("VIEW_3D", "WINDOW")
    with bpy.context.temp_override(window=person.hands.window, area=area, region=region):
        view = keymark("operators.shell.footage_view").footage_view(person.scene, person.take, area, region)
        x, y = view.to_region(pixel)
    return region.x + float(x), region.y + float(y)


def _expect_near(person: Person) -> None:
    placement = keymark("core.footage.camera_placement").CameraPlacement
    known, take = placement.of(person.known.camera.matrix_world), person.take
    apart = np.degrees(take.camera_tilt - known.tilt_rad), take.camera_height - known.height_m
    expect(
        abs(apart[0]) < TILT_DEGREES and abs(apart[1]) < HEIGHT_M,
        f"the camera found is {apart} from the true one",
    )
