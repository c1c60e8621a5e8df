"""The session's last step: the motion given to a character."""

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from driver import JOB_PATIENCE_S, Steps, expect, turns, until
from person import Person, keymark
from steps_reconstruct import cancelled, job

RETARGET = "keymark.retarget"
CLICKS_AT_MOST = 3  # From the final Action to the character that moves


def character(person: Person) -> Steps[None]:
    """Add a Rigify human, give it the motion, correct a bone, follow a newer motion, add another."""
    if person.take.finish.action is None:  # the session begins here
        bpy.ops.keymark.bake_motion()
        bpy.ops.wm.save_as_mainfile(filepath=str(person.folder / "session.blend"))
    yield from _basic_human(person)
    before = person.hands.clicks
    yield from person.undoable("adding a character", lambda: _click(person, "keymark.add_character"))
    clicks = person.hands.clicks - before
    added = person.take.characters[0]
    yield from person.hands.scroll("VIEW_3D", "WHEELDOWNMOUSE", 12)
    expect(
        added.armature.name == "Human" and not added.problem, f"the rig was not recognized: {added.problem}"
    )
    yield from person.look("character")
    yield from person.changes_nothing("cancelling the retargeting", lambda: cancelled(person, RETARGET))
    before = person.hands.clicks
    yield from person.undoable("retargeting", lambda: _watched(person))
    clicks += person.hands.clicks - before
    print(f"{clicks} clicks from the final Action to the character that moves")
    expect(clicks <= CLICKS_AT_MOST, f"it took {clicks} clicks")
    yield from _moves(person)
    yield from person.look("retargeted")
    yield from person.undoable("picking a bone", lambda: _pick(person, "hand.L", "hand_ik.L"))
    picked = person.take.characters[0].character_map.roles["hand.L"]
    found = picked.bones[0].bone  # IK and FK controls lie at one place
    expect(found in ("hand_ik.L", "hand_fk.L") and picked.source == "you", f"{found} was picked")
    yield from person.changes_nothing("cancelling the eyedropper", lambda: _pick(person, "hand.L", None))
    yield from person.hands.undo()
    yield from _again(person)
    yield from _another(person)


def _click(person: Person, command: str) -> Steps[None]:
    yield from person.hands.click_button(command)


def _watched(person: Person) -> Steps[None]:
    """Start the job by its button, look at the screen while it runs, and wait for its end."""
    yield from person.hands.click_button(RETARGET)
    progress = bpy.context.window_manager.keymark_progress
    yield from until(lambda: progress.fraction > 0.4 or not person.jobs(), "progress", JOB_PATIENCE_S)
    expect(person.jobs(), "the job ended before it could be seen")
    person.camera.shoot("retargeting")
    yield from person.wait_for_job()


def _moves(person: Person) -> Steps[None]:
    """Go through the clip to its middle; the character's hand is in several places."""
    chosen = person.take.characters[0]
    expect(chosen.armature.animation_data.action == chosen.results[0].action, "the rig shows another Action")
    hand = chosen.armature.pose.bones["hand_ik.L"]
    first, last = person.scene.frame_start, person.scene.frame_end
    places = []
    for share in (0.0, 0.15, 0.3, 0.8, 0.5):
        person.scene.frame_set(first + round(share * (last - first)))
        places.append(hand.matrix.translation.copy())
    expect(max((place - places[0]).length for place in places) > 0.05, "the rig does not move")
    person.step_done("Go to the middle")
    yield from person.hands.scroll("VIEW_3D", "WHEELDOWNMOUSE", 30)


def _pick(person: Person, role: str, bone: str | None) -> Steps[None]:
    """Click on a role's bone with the eyedropper, or press Esc instead."""
    yield from person.hands.invoke("keymark.pick_bone", role=role)
    expect(person.jobs(), "the eyedropper does not wait")
    if bone is None:
        yield from person.hands.press("ESC")
        return
    region, armature_object = person.hands.region("VIEW_3D", "WINDOW"), person.take.characters[0].armature
    posed = armature_object.pose.bones[bone]
    middle = armature_object.matrix_world @ ((posed.head + posed.tail) / 2.0)
    place = location_3d_to_region_2d(region, region.data, middle)
    yield from person.hands.move(region.x + place.x, region.y + place.y)
    yield from turns(2)
    person.camera.shoot("picking_a_bone")
    yield from person.hands.press("LEFTMOUSE")


def _again(person: Person) -> Steps[None]:
    """A final Action of other keys marks the result; retargeting again writes into the same Action."""
    first, count = person.take.characters[0].results[0].action.name, len(bpy.data.actions)
    person.take.finish.tolerance_mm = 4.0
    person.step_done("Keep the motion more exactly")
    yield from job(person, "keymark.bake_motion")
    expect(
        person.state.of_earlier(person.take.characters[0].results[0]), "the result is not marked as outdated"
    )
    yield from person.hands.move_over("VIEW_3D")
    yield from person.look("character_outdated")
    yield from job(person, RETARGET)
    result = person.take.characters[0].results[0]
    expect(
        not person.state.of_earlier(result) and result.action.name == first,
        "the result was not made again",
    )
    expect(len(bpy.data.actions) == count, "retargeting again left another Action")
    yield from person.undoable("marking the asset", lambda: person.hands.invoke("keymark.mark_result_asset"))


def _another(person: Person) -> Steps[None]:
    """A second character, chosen from two, stands in the list; removing it leaves its armature."""
    with bpy.context.temp_override(window=person.hands.window):
        for _ in range(2):
            bpy.ops.object.duplicate()
        bpy.ops.object.select_all(action="DESELECT")
    person.step_done("Duplicate the rig")
    yield from turns(3)
    yield from person.undoable("adding another", lambda: _choose(person))
    names = [each.armature.name for each in person.take.characters]
    expect(len(names) == 2 and names[1] in ("Human.001", "Human.002"), f"the characters are {names}")
    yield from person.look("characters")
    yield from person.undoable("removing one", lambda: person.hands.invoke("keymark.remove_character"))
    expect(names[1] in bpy.data.objects, "the armature is gone")


def _choose(person: Person) -> Steps[None]:
    """Choose the first of the armatures that a menu offers."""
    yield from person.hands.move_over("VIEW_3D")
    yield from person.hands.invoke("keymark.add_character")
    person.camera.shoot("choosing")
    yield from person.hands.press("RET")
    yield from turns(3)


def _basic_human(person: Person) -> Steps[None]:
    """Rigify's basic human, generated beside the performer, selected."""
    rigify_human = keymark("operators.bridge.character.rigify_human")
    rigify_human.enable_rigify()
    window, area = person.hands.window, person.hands.area("VIEW_3D")
    with bpy.context.temp_override(window=window, area=area, region=person.hands.region("VIEW_3D", "WINDOW")):
        if bpy.context.view_layer.objects.active is not None:
            bpy.ops.object.mode_set(mode="OBJECT")
        rigify_human.add_rigify_human()
    person.step_done("Generate the character")
    yield from turns(5)
