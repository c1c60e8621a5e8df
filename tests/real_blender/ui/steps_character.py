"""The session's last step: the motion given to a character."""

import addon_utils
import bpy
from driver import Steps, expect, turns
from person import Person
from steps_reconstruct import cancelled, job

CLICKS_AT_MOST = 3
"""From the final Action to the character that moves."""


def character(person: Person) -> Steps[None]:
    """Add a Rigify human, give it the motion, cancelled once, and look at every part of the panel."""
    if person.take.finish.action is None:  # the session begins here
        bpy.ops.keymark.bake_motion()
    rig = yield from _basic_human(person)
    before = person.hands.clicks
    yield from person.hands.click_button("keymark.add_character")
    expect(len(person.take.characters) == 1, "no character was added")
    yield from person.look("character_added")
    yield from job(person, "keymark.retarget")
    clicks = person.hands.clicks - before
    print(f"{clicks} clicks from the final Action to the character that moves")
    expect(clicks <= CLICKS_AT_MOST, f"it took {clicks} clicks")
    expect(rig.animation_data.action == person.take.characters[0].results[0].action, "the rig does not move")
    yield from person.look("retargeted")


def _basic_human(person: Person) -> Steps[bpy.types.Object]:
    """Rigify's basic human, generated beside the performer, selected."""
    addon_utils.enable("rigify", default_set=True)
    window, area = person.hands.window, person.hands.area("VIEW_3D")
    with bpy.context.temp_override(window=window, area=area, region=person.hands.region("VIEW_3D", "WINDOW")):
        bpy.ops.object.armature_basic_human_metarig_add()
        metarig = bpy.context.view_layer.objects.active
        bpy.ops.pose.rigify_generate()
    bpy.data.objects.remove(metarig)
    rig = bpy.data.objects["rig"]
    person.step_done("Generate the character")
    yield from turns(5)
    return rig
