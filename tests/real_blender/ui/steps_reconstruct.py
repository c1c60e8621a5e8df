"""The session's middle: keyframes and the reconstruction."""

import bpy
from driver import JOB_PATIENCE_S, Steps, expect, until
from person import Person, keymark


def keyframes(person: Person) -> Steps[None]:
    """Propose frames, go to one of them, and pose and store the keyframes."""
    propose = "keymark.propose_keyframes"
    if len(person.take.markers):  # with none to follow, it is over before a key can be pressed
        yield from person.changes_nothing("cancelling the proposal", lambda: cancelled(person, propose))
    yield from person.undoable("proposing keyframes", lambda: job(person, propose))
    expect(len(person.take.proposals) >= 2, "no keyframes were proposed")
    for direction in ("NEXT", "PREVIOUS"):
        before = person.scene.frame_current
        yield from person.hands.click_button("keymark.jump_to_proposal", f"direction='{direction}'")
        expect(person.scene.frame_current != before, f"{direction} does not leave frame {before}")
    for number, keyframe in enumerate(person.known.keyframes):
        frame = keyframe.index + person.known.frame_start
        person.scene.frame_set(frame)
        person.step_done(f"Go to frame {frame}")
        if number == 0:
            yield from person.undoable("fitting a pose", lambda: _fit(person))
            yield from person.look("fitted_pose")
        keymark("operators.bridge.pose").write_posture(person.take.armature, keyframe.posture)
        person.step_done(f"Pose frame {frame}")
        if number < 2:
            yield from person.undoable("storing a keyframe", lambda: _store(person))
            # Blender's undo and redo show what is keyed: the pose is there still.
        else:
            yield from _store(person)
    keyed = person.state.posed
    expect(len(keyed) == len(person.known.keyframes), f"keyframes are stored at {keyed}")
    yield from person.look("keyframes")


def reconstruct(person: Person) -> Steps[None]:
    """Reconstruct, cancelled by Esc once, then to the end."""
    name = "keymark.reconstruct"
    yield from person.changes_nothing("cancelling the reconstruction", lambda: cancelled(person, name))
    yield from person.undoable("reconstructing", lambda: _watched(person, name))
    expect(person.take.motion_action is not None, "there is no motion")
    yield from person.look("reconstructed")
    first = person.take.motion_action.name
    count = len(bpy.data.actions)
    yield from job(person, name)
    expect(person.take.motion_action.name == first, "running again made another Action")
    expect(len(bpy.data.actions) == count, "running again left another Action")


def _store(person: Person) -> Steps[None]:
    yield from person.hands.click_button("keymark.store_keyframe")


def _fit(person: Person) -> Steps[None]:
    yield from person.hands.click_button("keymark.fit_pose", "start='KEYFRAMES'")
    yield from person.wait_for_job()


def _watched(person: Person, command: str) -> Steps[None]:
    """Start a job by its button, look at the screen while it runs, and wait for its end."""
    yield from person.hands.click_button(command)
    progress = bpy.context.window_manager.keymark_progress
    yield from until(lambda: progress.fraction > 0.25 or not person.jobs(), "progress", JOB_PATIENCE_S)
    expect(person.jobs(), "the job ended before it could be seen")
    person.camera.shoot("reconstructing")
    yield from person.wait_for_job()


def cancelled(person: Person, command: str) -> Steps[None]:
    """Start a job by its button and press Esc while it runs."""
    yield from person.hands.click_button(command, settle=False)
    expect(person.jobs(), f"{command} does not run")
    yield from person.hands.press("ESC")
    yield from until(lambda: not person.jobs(), "the job to stop")


def job(person: Person, command: str) -> Steps[None]:
    """Start a job by its button and wait for its end."""
    yield from person.hands.click_button(command)
    yield from person.wait_for_job()
