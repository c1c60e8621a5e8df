"""The panel in every state from the clip to the character, on a screen of some size.

Usage: as of session.py, without a step. Each state leaves a picture; the step that is open then must fit into
the sidebar without scrolling, and at the end, when most is shown, each of them. In doubt, the mouse rests on
another candidate, which then is drawn.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import bpy  # noqa: E402
import steps_correct  # noqa: E402
import steps_export  # noqa: E402
import steps_prepare  # noqa: E402
from driver import Camera, Steps, drive, expect, turns, until  # noqa: E402
from person import Person, keymark  # noqa: E402

FOLDED_PX = 34  # Height of a folded step, the gap above it included


def session(take: Path, folder: Path, camera: Camera) -> Steps[None]:
    """Go from one state to the next by what buttons call, and look at each."""
    person = Person(take, folder, camera, hurried=True)
    yield from steps_prepare.clip(person)
    yield from seen(person, "clip", "footage")
    steps_prepare.performer(person, "keypoints.json")
    yield from seen(person, "performer", "actor")
    bpy.ops.keymark.pose_all()
    yield from seen(person, "poses", "keyframes")
    yield from correcting(person)
    bpy.ops.keymark.reconstruct()
    yield from seen(person, "motion", "reconstruct")
    keymark("operators.bridge.character.rigify_human").enable_rigify()
    bpy.ops.keymark.add_rigify_human()
    bpy.ops.keymark.retarget()
    yield from seen(person, "character", "character")
    bpy.ops.keymark.bake_motion()
    yield from seen(person, "export", "finish")
    steps_export.add_mixamo(person)
    bpy.ops.keymark.retarget()
    yield from seen(person, "two_characters", "character")
    yield from steps_export.exported(person)
    for step in keymark("operators.shell.take_state").STEPS:
        yield from fits(person, step)


def correcting(person: Person) -> Steps[None]:
    """The most doubtful pose, and one wrist of it dragged."""
    doubtful = min(person.take.matching.matches, key=lambda match: match.confidence)
    person.scene.frame_set(round(doubtful.frame))
    place = yield from person.hands.find_button("keymark.replace_match", "candidate=1")
    yield from person.hands.move(*place)
    overlay = keymark("operators.overlays.tools")
    yield from until(lambda: overlay._looked_at[1] == 1, "the figure of the candidate under the mouse")
    yield from person.look("candidate")
    yield from person.hands.move_over("VIEW_3D")
    yield from person.hands.invoke("keymark.drag_joints")
    expect(person.jobs(), "joints cannot be dragged")
    yield from steps_correct.dragged(person, "wrist.L")
    yield from person.look("correcting")
    yield from steps_correct.ended(person, "ESC")


def seen(person: Person, name: str, step: str) -> Steps[None]:
    """Picture a state with one step open."""
    person.step_done(name)
    yield from fits(person, step)
    yield from person.look(name)


def fits(person: Person, step: str) -> Steps[None]:
    """Open a step: but for the lines of later ones, the sidebar shows all without scrolling."""
    steps = list(keymark("operators.shell.take_state").STEPS)
    setattr(bpy.context.window_manager.keymark_steps, step, True)
    yield from person.hands.scroll("VIEW_3D", "WHEELUPMOUSE", 40)
    yield from still(person)
    _, top = person.hands.showing("VIEW_3D")
    yield from person.hands.scroll("VIEW_3D", "WHEELDOWNMOUSE", 40)
    yield from still(person)
    below = top - person.hands.showing("VIEW_3D")[1]
    yield from person.hands.scroll("VIEW_3D", "WHEELUPMOUSE", 40)
    later = FOLDED_PX * (len(steps) - 1 - steps.index(step))
    expect(
        below <= later, f"with the step {step} open {below} px are below the sidebar, {later} of them folded"
    )
    print(f"{step}: {below} px below the sidebar", flush=True)


def still(person: Person) -> Steps[bytes]:
    """What the screen shows, once panels have slid to their places."""
    before, now = b"", person.camera.seen()
    while now != before:
        yield from turns(4)
        before, now = now, person.camera.seen()
    return now


if __name__ == "__main__":
    take_name, folder_name = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    drive(session(Path(take_name), Path(folder_name), taking), taking)
