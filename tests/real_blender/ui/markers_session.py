"""A person with markers and a wall panel of a marker's color: five clicks, mistakes, and *Not This*.

Usage: blender-screen --factory-startup --addons MODULE --enable-event-simulate --python markers_session.py
       -- TAKE FOLDER LEFT,TOP,RIGHT,BOTTOM

The last word is where the panel is in the picture.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import numpy as np  # noqa: E402
import steps_prepare  # noqa: E402
from driver import Camera, Steps, drive, expect, turns  # noqa: E402
from person import Person, keymark  # noqa: E402
from steps_prepare import check_colors, click_pixel, expect_asked, sleeve_pixel  # noqa: E402

Box = tuple[int, int, int, int]


def session(person: Person, panel: Box) -> Steps[None]:
    """The take opened without its markers; then all of step 2 that has to do with them."""
    yield from steps_prepare.start_empty(person)
    yield from steps_prepare.opened(person, False)
    person.take.markers.clear()
    person.step_done("Remove the markers")
    yield from turns(3)
    yield from person.look("no_markers")
    yield from person.changes_nothing("cancelling in another frame", lambda: _cancel_elsewhere(person))
    yield from person.undoable("picking with mistakes", lambda: _pick_with_mistakes(person, panel))
    expect([m.segment for m in person.take.markers] == [s.segment for s in person.known.markers], "five")
    check_colors(person)
    yield from _one_row(person)
    yield from _leave_out(person, panel)


def _cancel_elsewhere(person: Person) -> Steps[None]:
    """A click, one in the next frame, and Esc in the first."""
    yield from person.hands.click_button("keymark.pick_markers")
    yield from click_pixel(person, sleeve_pixel(person, 0))
    pixel, first = sleeve_pixel(person, 1), person.scene.frame_current
    yield from person.hands.press("RIGHT_ARROW")
    expect(person.scene.frame_current == first + 1, "the arrow key does not go to another frame")
    yield from click_pixel(person, pixel)
    expect_asked(person, 2)
    yield from person.hands.press("LEFT_ARROW")
    yield from person.hands.press("ESC")
    expect(not person.jobs(), "Esc does not end the clicks")


def _pick_with_mistakes(person: Person, panel: Box) -> Steps[None]:
    """A skipped marker is asked for again at the end; a wrong click is taken back."""
    yield from person.hands.click_button("keymark.pick_markers")
    yield from click_pixel(person, sleeve_pixel(person, 0))
    yield from person.look("asked")
    yield from person.hands.press("TAB")
    expect_asked(person, 2)
    yield from click_pixel(person, np.array([panel[0] + 2.0, panel[1] - 6.0]))
    expect_asked(person, 3)
    yield from person.hands.press("BACK_SPACE")
    expect_asked(person, 2)
    for number in (2, 3, 4):
        yield from click_pixel(person, sleeve_pixel(person, number))
    expect_asked(person, 1)
    yield from turns(60)
    yield from person.look("masks_while_picking")
    yield from click_pixel(person, sleeve_pixel(person, 1))
    yield from person.wait_for_job()


def _one_row(person: Person) -> Steps[None]:
    """The eyedropper in a row picks that one; Esc leaves it as it was."""
    colors = [tuple(marker.color) for marker in person.take.markers]
    yield from person.hands.click_button("keymark.pick_marker_color", "row=3")
    yield from person.look("one_row")
    yield from click_pixel(person, sleeve_pixel(person, 3))
    yield from person.wait_for_job()
    now = [tuple(marker.color) for marker in person.take.markers]
    expect([*now[:3], *now[4:]] == [*colors[:3], *colors[4:]], "another marker got the color")
    expect(len(now) == 5, "the eyedropper added a marker")


def _leave_out(person: Person, panel: Box) -> Steps[None]:
    """Brush the panel away, undo it, and take the proposal instead."""
    warned = [marker.name for marker in person.take.markers if "stays still" in marker.warning]
    expect(warned == ["forearm.L"], f"warnings of still areas: {warned}")
    person.take.active_marker = 1
    person.step_done("Choose the sleeve")
    yield from turns(3)
    yield from person.look("warned")
    yield from person.changes_nothing("cancelling the brush", lambda: _brush(person, panel, "ESC"))
    yield from person.undoable("brushing", lambda: _brush(person, panel, "RET"))
    expect(not person.take.markers[1].warning, f"still warned: {person.take.markers[1].warning}")
    yield from person.look("brushed")
    yield from person.hands.undo()
    yield from person.undoable("leaving still areas out", lambda: _still(person))
    expect(len(person.take.ignored_regions) == 1, "not one still area")
    person.take.ignored_regions[0].some_frames = True
    person.take.ignored_regions[0].some_frames = False
    person.step_done("Try some frames")
    yield from person.hands.click_button("keymark.check_markers")
    yield from person.wait_for_job()
    expect(not person.take.markers[1].warning, f"still warned: {person.take.markers[1].warning}")
    yield from person.look("still_area")


def _still(person: Person) -> Steps[None]:
    yield from person.hands.click_button("keymark.ignore_still_areas")
    yield from person.wait_for_job()


def _brush(person: Person, panel: Box, end: str) -> Steps[None]:
    """The button, a larger brush, strokes over the panel, one too many, and a key."""
    yield from person.hands.click_button("keymark.ignore_region")
    yield from person.hands.press("RIGHT_BRACKET")
    left, top, right, bottom = panel
    for y in np.linspace(top, bottom, 5):
        yield from person.hands.drag(_place(person, left, y), _place(person, right, y))
    if end == "RET":
        yield from person.hands.drag(_place(person, 5.0, 5.0), _place(person, 60.0, 5.0))
        yield from person.hands.press("BACK_SPACE")
        yield from person.look("brushing")
    yield from person.hands.press(end)
    yield from person.wait_for_job()


def _place(person: Person, x: float, y: float) -> tuple[float, float]:
    area, region = person.hands.area("VIEW_3D"), person.hands.region("VIEW_3D", "WINDOW")
    view = keymark("operators.shell.footage_view").footage_view(person.scene, person.take, area, region)
    across, up = view.to_region((x, y))
    return region.x + float(across), region.y + float(up)


if __name__ == "__main__":
    take_name, folder_name, where = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    a, b, c, d = (int(number) for number in where.split(","))
    drive(session(Person(Path(take_name), Path(folder_name), taking), (a, b, c, d)), taking)
