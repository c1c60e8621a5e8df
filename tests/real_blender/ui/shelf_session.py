"""A person looks at keyframe libraries: the popover, and one as pose assets in the asset browser.

Usage: as of session.py, without a step.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import bpy  # noqa: E402
import steps_prepare  # noqa: E402
from driver import Camera, Steps, drive, expect, turns  # noqa: E402
from person import Person  # noqa: E402

TITLE = "Anna Exercising"


def session(take: Path, folder: Path, camera: Camera) -> Steps[None]:
    """Learn a library of a motion, look at it, and bring it into the file as pose assets."""
    person = Person(take, folder, camera)
    yield from steps_prepare.start_empty(person)
    yield from steps_prepare.opened(person, reconstructed=True)
    bpy.ops.keymark.learn_library(title=TITLE, author="Anna")
    registry = bpy.context.window_manager.keymark_shelf
    expect(registry.libraries[registry.active].title == TITLE, "the library that was learned is not chosen")
    yield from person.hands.invoke("keymark.edit_library")
    expect(any(action.asset_data for action in bpy.data.actions), "there are no pose assets")
    yield from person.hands.move_over("VIEW_3D")
    yield from person.hands.invoke("wm.call_panel", name="KEYMARK_PT_libraries")  # as its button would
    yield from person.look("libraries")
    yield from person.hands.press("ESC")
    yield from assets(person)


def assets(person: Person) -> Steps[None]:
    area = person.hands.area("VIEW_3D")
    area.ui_type = "ASSETS"
    yield from turns(5)
    browser = person.hands.area("FILE_BROWSER").spaces.active
    browser.params.asset_library_reference = "LOCAL"
    browser.params.display_size = 72
    yield from turns(60)  # pictures are read by and by
    yield from person.look("assets")


if __name__ == "__main__":
    take_name, folder_name = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    drive(session(Path(take_name), Path(folder_name), taking), taking)
