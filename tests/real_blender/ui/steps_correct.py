"""A session's corrections: joints dragged over the footage, in depth and from the side; a limb flipped."""

from collections.abc import Callable

import bpy
import numpy as np
from driver import Steps, expect, turns, until
from person import Person, keymark

DRAGGED_PX = 42.0
NEAR_PX = 3.0  # How near to the mouse a dragged joint must be seen
MOVED_M = 0.03
SAME_M = 0.001


def correct(person: Person) -> Steps[None]:
    """Drag a wrist at a keyframe, take drags back, push it in depth, flip the arm; all of it is undone."""
    yield from go_to_keyframe(person)
    yield from begun(person)
    yield from person.hands.move(*seen(person, "wrist.L"))
    yield from person.look("drag_joints")
    yield from person.changes_nothing("a drag that ends with Esc", lambda: dropped(person, "wrist.L"))
    yield from person.changes_nothing("Esc after a drag", lambda: given_up(person, "wrist.L"))
    yield from begun(person)
    yield from person.undoable("dragging a wrist", lambda: stored(person, dragged, "wrist.L"))
    yield from taken_back(person)
    yield from begun(person)
    yield from person.undoable("pushing a wrist", lambda: stored(person, pushed, "wrist.L"))
    yield from taken_back(person)
    yield from begun(person)
    yield from person.undoable("flipping an arm", lambda: flipped(person, "elbow.L"))
    yield from taken_back(person)
    yield from from_the_side(person)
    yield from person.look("corrected")


def begun(person: Person) -> Steps[None]:
    yield from person.hands.click_button("keymark.drag_joints")
    yield from until(lambda: person.jobs(), "the tool")


def ended(person: Person, key: str) -> Steps[None]:
    yield from person.hands.press(key)
    yield from until(lambda: not person.jobs(), "the tool to end")


def stored(person: Person, drag: Callable[[Person, str], Steps[None]], joint: str) -> Steps[None]:
    """Drag a joint, and store the pose with Enter: it is the one that was shown."""
    yield from drag(person, joint)
    shown = place(person, joint)
    yield from ended(person, "RET")
    bpy.context.view_layer.update()
    off = float(np.linalg.norm(place(person, joint) - shown))
    expect(off < SAME_M, f"the joint is stored {off:.4f} m from where it was dragged")
    keyed = person.state.posed
    expect(person.scene.frame_current in keyed, "the keyframe is gone")


def given_up(person: Person, joint: str) -> Steps[None]:
    """Drag a joint, then take it back with Esc, which ends the tool."""
    before = place(person, joint)
    yield from dragged(person, joint)
    yield from person.look("dragged")
    yield from ended(person, "ESC")
    off = float(np.linalg.norm(place(person, joint) - before))
    expect(off < SAME_M, f"Esc leaves the joint {off:.4f} m from where it was")


def go_to_keyframe(person: Person) -> Steps[None]:
    frames = person.state.posed
    person.scene.frame_set(round(frames[len(frames) // 2]))
    person.step_done("Go to a keyframe")
    yield from turns(3)


def place(person: Person, joint: str) -> np.ndarray:
    """Where a joint is in the world [m]."""
    places = keymark("operators.bridge.actor_bones").joint_places(person.take.armature)
    return np.array(places[keymark("core.body.human").HUMAN.point_names.index(joint)])


def seen(person: Person, joint: str) -> tuple[float, float]:
    """Where the viewport shows it, in the window [px]."""
    return seen_at(person, place(person, joint))


def seen_at(person: Person, there: np.ndarray) -> tuple[float, float]:
    """Where the viewport shows a place (3,), in the window [px]."""
    region = person.hands.region("VIEW_3D", "WINDOW")
    view = keymark("operators.shell.footage_view").WorldInRegion(region, region.data)
    x, y = view.position(there)
    return region.x + x, region.y + y


def apart_px(first: tuple[float, float], second: tuple[float, float]) -> float:
    return float(np.linalg.norm(np.subtract(first, second)))


def dragged(person: Person, joint: str) -> Steps[None]:
    """Drag a joint toward its shoulder, where it can come; it must then lie under the mouse."""
    start = np.array(seen(person, joint))
    toward = np.array(seen(person, joint.replace("wrist", "shoulder"))) - start
    end = start + DRAGGED_PX * toward / np.linalg.norm(toward)
    yield from person.hands.drag(start, end)
    off = apart_px(seen(person, joint), end)
    expect(off < NEAR_PX, f"the joint is {off:.1f} px beside the mouse")


def dropped(person: Person, joint: str) -> Steps[None]:
    """Begin to drag a joint, and press Esc with the button down; the tool goes on."""
    hands = person.hands
    start = seen(person, joint)
    yield from hands.move(*start)
    hands.window.event_simulate(type="LEFTMOUSE", value="PRESS", x=hands.x, y=hands.y)
    yield from turns(2)
    before = place(person, joint)
    yield from hands.move(start[0] + 40.0, start[1])
    yield from turns(2)
    expect(np.linalg.norm(place(person, joint) - before) > MOVED_M, "the joint does not follow the mouse")
    person.camera.shoot("dragging")
    yield from hands.press("ESC")
    hands.window.event_simulate(type="LEFTMOUSE", value="RELEASE", x=hands.x, y=hands.y)
    yield from turns(2)
    expect(person.jobs(), "Esc in a drag ended the tool")


def pushed(person: Person, joint: str) -> Steps[None]:
    """Drag a joint upward with Ctrl: away from the camera, at its place in the picture."""
    hands = person.hands
    start, before = seen(person, joint), place(person, joint)
    yield from hands.move(*start)
    hands.window.event_simulate(type="LEFTMOUSE", value="PRESS", x=hands.x, y=hands.y)
    yield from turns(2)
    for up in (8, 16, 24):
        hands.window.event_simulate(
            type="MOUSEMOVE", value="NOTHING", x=hands.x, y=round(start[1]) + up, ctrl=True
        )
        yield from turns(2)
    hands.window.event_simulate(
        type="LEFTMOUSE", value="RELEASE", x=hands.x, y=round(start[1]) + 24, ctrl=True
    )
    yield from turns(3)
    eye = np.array(person.take.camera.matrix_world.translation)
    moved = place(person, joint) - before
    farther = float(moved @ (before - eye) / np.linalg.norm(before - eye))
    expect(farther > MOVED_M, f"the joint moved {farther:.3f} m away from the camera")


def flipped(person: Person, joint: str) -> Steps[None]:
    """Press F over a joint: its limb leans the other way."""
    before = place(person, joint), place(person, joint.replace("elbow", "wrist"))
    yield from person.hands.move(*seen(person, joint))
    yield from person.hands.press("F")
    after = place(person, joint), place(person, joint.replace("elbow", "wrist"))
    expect(max(np.linalg.norm(np.subtract(after, before), axis=-1)) > 0.02, "the limb was not flipped")


def from_the_side(person: Person) -> Steps[None]:
    """From the side a drag moves in that view's plane; then look through the camera again."""
    hands = person.hands
    yield from hands.move_over("VIEW_3D")
    yield from hands.press("NUMPAD_3")
    yield from turns(20)
    yield from person.look("from_the_side")
    yield from person.undoable("dragging from the side", lambda: stored(person, dragged, "wrist.L"))
    yield from taken_back(person)
    yield from hands.move_over("VIEW_3D")
    yield from hands.press("NUMPAD_0")
    view = hands.area("VIEW_3D").spaces.active
    yield from until(lambda: view.region_3d.view_perspective == "CAMERA", "the camera's view")
    yield from turns(20)


def taken_back(person: Person) -> Steps[None]:
    running = person.jobs()
    yield from person.hands.undo()
    expect(bool(person.jobs()) == bool(running), "undo ended the tool")
    bpy.context.view_layer.update()
