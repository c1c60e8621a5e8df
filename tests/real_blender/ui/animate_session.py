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
import steps_correct  # noqa: E402
import steps_first  # noqa: E402
from driver import Camera, Steps, drive, expect, turns  # noqa: E402
from person import EXTENSION, Person  # noqa: E402
from steps_prepare import choose_file  # noqa: E402
from steps_reconstruct import job  # noqa: E402

HEIGHT_M, TYPED = 1.71, 171.0
"""The performer's height, and as a beginner types it."""
MOST_KEYS = 30  # Those that undo everything among them


def animate(person: Person, clip: Path) -> Steps[None]:
    """The first button, and in its file browser the clip; the character is a Rigify human by itself."""

    def ask() -> Steps[None]:
        yield from person.hands.click_button("keymark.animate")

    def answer() -> Steps[None]:
        yield from ask()
        yield from turns(20)
        operator = person.hands.area("FILE_BROWSER").spaces.active.active_operator
        expect(operator.character == "RIGIFY", f"the character is {operator.character}")
        operator.stature = TYPED

    wrong, done = person.folder / "words.mp4", (person.hands.clicks, person.hands.keys)
    wrong.write_text("no video", encoding="utf-8")
    yield from choose_file(person, answer, wrong, "RET", closes=False)
    yield from turns(20)
    again = person.hands.area("FILE_BROWSER").spaces.active.active_operator
    expect("words.mp4" in again.problem, f"of a file that is no video it says '{again.problem}'")
    expect(abs(again.stature - HEIGHT_M) < 1e-3, f"the height that was typed became {again.stature}")
    expect(not len(person.scene.keymark.takes), "a mistake left a take")
    yield from person.look("mistaken")
    yield from person.hands.press("ESC")
    yield from turns(10)
    person.hands.clicks, person.hands.keys = done  # of whoever makes no mistake
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


def corrected(person: Person) -> Steps[None]:
    """A wrist dragged in two poses, the doubtful ones first, and the character performs that motion."""
    hands = person.hands
    for number in range(2):
        matching = person.take.matching
        if person.state.doubtful:
            yield from hands.click_button("keymark.jump_to_match", "only_doubtful=True")
        else:  # a click on a line of the list
            matching.shown_match = number + 1
            hands.clicks += 1
            person.step_done("Choose a pose")
        frame = person.scene.frame_current
        yield from steps_correct.begun(person)
        yield from steps_correct.stored(person, steps_correct.dragged, "wrist.L")
        expect(frame in person.state.posed, f"frame {frame} is not put right")
        hands.clicks += 1  # the drag
    yield from job(person, "keymark.update")
    expect(not person.state.is_outdated, "something is made of what has changed since")
    yield from person.look("put_right")


def session(clip: Path, folder: Path, camera: Camera) -> Steps[None]:
    """All of it, two poses put right, and all taken back by Ctrl Z."""
    example = Path(sys.modules[EXTENSION].__file__).parent / "presets" / "demo" / "greeting"
    person = Person(example, folder, camera, hurried=True)
    yield from steps_first.sidebar(person)
    yield from animate(person, clip)
    summary = person.summary()
    (folder / "summary.txt").write_text(summary + "\n", encoding="utf-8")
    print(f"From Blender as it starts to a moving character: {summary}", flush=True)
    yield from steps_first.play(person)
    yield from corrected(person)
    corrections = person.summary()
    (folder / "corrections.txt").write_text(corrections + "\n", encoding="utf-8")
    print(f"The same with two poses put right: {corrections}", flush=True)
    while len(person.scene.keymark.takes) and person.hands.keys < MOST_KEYS:
        yield from person.hands.undo()
    expect(not len(person.scene.keymark.takes), "animating was not undone")


if __name__ == "__main__":
    clip_name, folder_name = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    drive(session(Path(clip_name), Path(folder_name), taking), taking)
