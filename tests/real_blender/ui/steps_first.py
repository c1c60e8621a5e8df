"""The steps of somebody's first session: an example, its motion, and a character that performs it."""

import shutil
from pathlib import Path

import bpy
from driver import JOB_PATIENCE_S, Steps, expect, turns, until
from hands import NOTCHES
from person import Person
from steps_prepare import choose_file
from steps_reconstruct import job

FRAMES_SEEN = 12  # As many pictures of the motion are waited for; a virtual screen draws a few a second


def sidebar(person: Person) -> Steps[None]:
    """Blender as it starts, with its cube; N and Keymark's tab."""
    expect("Cube" in bpy.data.objects, "Blender did not start as it always does")
    yield from person.look("start")
    yield from person.hands.open_sidebar("VIEW_3D", "Keymark")
    person.hands.clicks = 1  # where a tab is no script can see: it tries one after the other
    yield from person.look("panel")


def example(person: Person) -> Steps[None]:
    """Open the first of the examples; the picture is there without any further click."""
    yield from person.hands.click_button("keymark.open_example")
    yield from person.look("examples")
    yield from person.hands.press("LEFTMOUSE")  # the first entry lies under the mouse
    yield from until(lambda: len(person.scene.keymark.takes), "the example")
    yield from turns(10)
    view = person.hands.area("VIEW_3D").spaces.active
    expect(view.region_3d.view_perspective == "CAMERA", "the footage is not shown")
    expect(bpy.data.objects["Cube"].hide_get(), "Blender's cube stands before the performer")
    expect(not bpy.data.filepath, "the file was saved")
    yield from person.look("example")


def reconstruct(person: Person) -> Steps[None]:
    yield from job(person, "keymark.reconstruct")
    expect(person.take.motion_action is not None, "there is no motion")
    yield from person.look("reconstructed")


def play(person: Person) -> Steps[None]:
    yield from person.hands.move_over("VIEW_3D")
    seen = set()
    yield from person.hands.press("SPACE")

    def has_seen() -> bool:
        seen.add(person.scene.frame_current)
        return len(seen) > FRAMES_SEEN

    yield from until(has_seen, "the motion")
    yield from person.hands.press("SPACE")
    expect(not person.hands.window.screen.is_animation_playing, "it plays on")
    yield from person.look("played")


def review(person: Person) -> Steps[None]:
    """Turn the wheel, and look at what Keymark says of the motion; there is nothing to click on for that."""
    expect(person.take.review.confidence > 0.5, f"the confidence is {person.take.review.confidence}")
    yield from person.hands.scroll("VIEW_3D", "WHEELDOWNMOUSE", NOTCHES)
    yield from person.look("review")


def character(person: Person) -> Steps[None]:
    """Rigify's human, whose add-on Blender asks to enable."""
    yield from person.hands.click_button("keymark.add_rigify_human")
    yield from person.look("enable_rigify")
    expect(not person.take.characters, "the add-on was enabled unasked")
    yield from person.hands.press("RET")
    yield from until(lambda: len(person.take.characters), "the character", JOB_PATIENCE_S)
    yield from turns(10)
    chosen = person.take.characters[0]
    expect(chosen.armature is not None and not chosen.problem, f"it was not recognized: {chosen.problem}")
    yield from person.look("character")


def retarget(person: Person) -> Steps[None]:
    """One click; the character stands where the performer does."""
    yield from job(person, "keymark.retarget")
    results = person.take.characters[0].results
    expect(len(results) and results[0].action is not None, "the character has no Action")
    yield from person.look("retargeted")


def take_back(person: Person) -> Steps[None]:
    """Ctrl Z takes back the retargeting, the character, the motion and the example, step by step."""
    kept = len(bpy.data.objects)
    yield from person.hands.undo()  # where playing ended
    yield from person.hands.undo()
    expect(not len(person.take.characters[0].results), "the retargeting was not undone")
    yield from person.hands.undo()
    expect(not len(person.take.characters) and len(bpy.data.objects) < kept, "the character was not undone")
    yield from person.hands.undo()  # where playing ended
    yield from person.hands.undo()
    expect(person.take.motion_action is None, "the reconstruction was not undone")
    yield from person.hands.undo()
    expect(not len(person.scene.keymark.takes), "the example was not undone")
    expect(not bpy.data.objects["Cube"].hide_get(), "Blender's cube is still hidden")
    yield from person.look("taken_back")


def copy(person: Person) -> Steps[None]:
    """The other example, copied to a folder: cancelled once, which leaves nothing, and then done."""
    folder = person.folder / "copies"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    yield from choose_file(person, lambda: _ask_for_copy(person), folder, "ESC")
    expect(not len(person.scene.keymark.takes), "a cancelled copy was opened")
    expect(not list(folder.iterdir()), "a cancelled copy was written")
    yield from choose_file(person, lambda: _ask_for_copy(person), folder, "RET")
    yield from until(lambda: len(person.scene.keymark.takes), "the copy")
    clip = Path(bpy.path.abspath(person.take.clip.filepath))
    expect(clip == folder / "greeting" / "clip.mp4", f"the clip is {clip}")
    yield from person.look("plain_clothes")
    shutil.rmtree(folder)


def _ask_for_copy(person: Person) -> Steps[None]:
    yield from person.hands.invoke("keymark.open_example", example="GREETING", copy=True)
