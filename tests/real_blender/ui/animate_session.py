"""From Blender as it starts to a moving character, from a clip of one's own and a height.

Usage: blender-screen --factory-startup --addons MODULE --enable-event-simulate --python animate_session.py
       -- CLIP FOLDER

By mouse and keys; each step leaves a picture in FOLDER. Which file is chosen and how tall the performer is
would be a click and some keys each: where a file browser shows them no script can see.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import bpy  # noqa: E402
import steps_first  # noqa: E402
from driver import Camera, Steps, drive, expect, turns  # noqa: E402
from person import EXTENSION, Person  # noqa: E402
from steps_prepare import choose_file  # noqa: E402

HEIGHT_M = 1.71


def animate(person: Person, clip: Path) -> Steps[None]:
    """The first button, and in its file browser the clip; the character is a Rigify human by itself."""

    def ask() -> Steps[None]:
        yield from person.hands.click_button("keymark.animate")

    def answer() -> Steps[None]:
        yield from ask()
        yield from turns(20)
        operator = person.hands.area("FILE_BROWSER").spaces.active.active_operator
        expect(operator.character == "RIGIFY", f"the character is {operator.character}")
        operator.stature = HEIGHT_M

    yield from choose_file(person, answer, clip, "RET")
    yield from turns(10)
    yield from person.look("running")
    yield from person.wait_for_job()
    take = person.take
    expect(take.motion_action is not None and take.finish.action is not None, "there is no motion")
    expect(abs(take.stature - HEIGHT_M) < 1e-3, f"the height is {take.stature}")
    expect(len(take.characters) == 1 and len(take.characters[0].results) == 1, "nobody performs it")
    expect(bpy.data.objects["Cube"].hide_get(), "Blender's cube stands before the performer")
    yield from person.look("animated")


def session(clip: Path, folder: Path, camera: Camera) -> Steps[None]:
    """All of it; then one Ctrl Z takes it back."""
    example = Path(sys.modules[EXTENSION].__file__).parent / "presets" / "demo" / "greeting"
    person = Person(example, folder, camera, hurried=True)
    yield from steps_first.sidebar(person)
    yield from animate(person, clip)
    summary = person.summary()
    (folder / "summary.txt").write_text(summary + "\n", encoding="utf-8")
    print(f"From Blender as it starts to a moving character: {summary}", flush=True)
    yield from steps_first.play(person)
    yield from person.hands.undo()  # where playing ended
    yield from person.hands.undo()
    expect(not len(person.scene.keymark.takes), "animating was not undone")


if __name__ == "__main__":
    clip_name, folder_name = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    drive(session(Path(clip_name), Path(folder_name), taking), taking)
