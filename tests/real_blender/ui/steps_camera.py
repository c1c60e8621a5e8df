"""The camera of the session's first step: found from lines and from the performer, by mouse and keys."""

from typing import Any

import bpy
import numpy as np
from driver import Steps, expect, turns
from numpy.typing import NDArray
from person import Person, keymark

KNOWN_M = 1.2  # Height of something that stands on the floor, wholly in the picture
ASIDE_M = (0.9, 0.7, 0.5, 0.3)
"""How far beside the performer a line is drawn: as far as the picture shows it well."""
SHOWN = 0.5  # Least share of such a line that the picture shows
EDGE = 0.03  # Share of the picture at its edges in which nothing is drawn
TILT_DEGREES, HEIGHT_M = 3.0, 0.2
"""How far the camera found may be from the true one, drawn by the pixel with a guessed lens."""


def find_camera(person: Person) -> Steps[None]:
    """Lines are asked for before markers, drawn, forgotten by Esc, taken by Enter, and undone by one step."""
    expect("camera" in person.state.next[1], f"after loading, '{person.state.next[1]}' is next")
    yield from person.changes_nothing("forgetting lines", lambda: _draw(person, "ESC"))
    yield from person.undoable("finding the camera", lambda: _draw(person, "RET"))
    _expect_near(person)
    expect("camera" not in person.state.next[1], f"with the camera, '{person.state.next[1]}' is next")
    person.scene.keymark.overlays.show_floor_grid = True
    person.step_done("Show the floor")
    yield from person.look("camera")
    person.scene.keymark.overlays.show_floor_grid = False
    person.step_done("Hide the floor")


def _draw(person: Person, key: str) -> Steps[None]:
    """Draw two verticals, two lines on the floor and a known height, type that, then press a key."""
    yield from person.hands.click_button("keymark.camera_from_lines", "kind='VERTICAL'")
    for start, end in _lines(person):
        yield from person.hands.drag(_place(person, start), _place(person, end))
    yield from person.hands.write(f"{KNOWN_M:g}")
    if key == "RET":
        yield from person.look("lines")
    yield from person.hands.press(key)
    yield from turns(3)
    expect(not person.jobs(), f"{key} does not end the lines")


def _lines(person: Person) -> list[NDArray[np.float64]]:
    """Ends (2, 2) of five lines in the footage [px] that lie about the performer as the person knows."""
    known = person.known
    heading = keymark("core.camera.camera_fields").heading_rad(known.camera.matrix_world)
    ahead = np.array([-np.sin(heading), np.cos(heading), 0.0])
    right, up = np.array([ahead[1], -ahead[0], 0.0]), np.array([0.0, 0.0, 1.0])
    foot = known.keyframes[0].posture.translation * [1.0, 1.0, 0.0]
    plumb, level = (0.1 * up, 1.9 * up), (-ahead, ahead)
    drawn = [_beside(known, foot, side * right, line) for line in (plumb, level) for side in (-1.0, 1.0)]
    height = _shown(known, foot, foot + KNOWN_M * up)
    expect(height is not None, "the known height is not in the picture")
    return [*drawn, height]


def _beside(
    known: Any, foot: NDArray[np.float64], side: NDArray[np.float64], line: tuple[NDArray[np.float64], ...]
) -> NDArray[np.float64]:
    """What the picture shows of a line on one side of the performer."""
    places = (foot + aside * side for aside in ASIDE_M)
    shown = (_shown(known, *(place + end for end in line)) for place in places)
    found = next((ends for ends in shown if ends is not None), None)
    expect(found is not None, "a line that the person would draw is not in the picture")
    return found


def _shown(known: Any, start: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """The ends of what the picture shows of a line in the world; None where that is too little."""
    shares = np.linspace(0.0, 1.0, 200)[:, None]
    pixel: NDArray[np.float64] = known.camera.project(start + shares * (end - start))[0]
    size = np.array(known.camera.resolution)
    inside = ((pixel > EDGE * size) & (pixel < (1.0 - EDGE) * size)).all(axis=1)
    return pixel[inside][[0, -1]] if inside.mean() > SHOWN else None


def _place(person: Person, pixel: NDArray[np.float64]) -> tuple[float, float]:
    area, region = person.hands.area("VIEW_3D"), person.hands.region("VIEW_3D", "WINDOW")
    with bpy.context.temp_override(window=person.hands.window, area=area, region=region):
        view = keymark("operators.shell.footage_view").footage_view(person.scene, person.take, area, region)
        x, y = view.to_region(pixel)
    return region.x + float(x), region.y + float(y)


def _expect_near(person: Person) -> None:
    placement = keymark("core.camera.camera_fields").CameraPlacement
    known, take = placement.of(person.known.camera.matrix_world), person.take
    apart = np.degrees(take.camera_tilt - known.tilt_rad), take.camera_height - known.height_m
    expect(
        abs(apart[0]) < TILT_DEGREES and abs(apart[1]) < HEIGHT_M,
        f"the camera found is {apart} from the true one",
    )
