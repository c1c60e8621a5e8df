"""Characters in a take's list: which armatures may be one, and that the actor's field takes actors alone."""

from pathlib import Path

import bpy
import pytest
from _armatures import build_character
from _characters import plain_character
from bpy.types import Object, PropertyGroup
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.retarget.character import Character
from keymark.operators.bridge.armature import build_armature
from keymark.operators.character.characters import candidates, may_be_character
from keymark.operators.shell.takes import active_take, add_take

pytestmark = pytest.mark.usefixtures("registered")


def accepts(owner: PropertyGroup, name: str, candidate: Object) -> bool:
    """Whether the field of a pointer lists an object."""
    annotation = type(owner).__annotations__[name]
    return bool(annotation.keywords["poll"](owner, candidate))


def named(name: str) -> Character:
    """The plain character under another name."""
    return Character(name, plain_character().bones)


def test_the_selected_armature_is_added_and_recognized(take: PropertyGroup, rig: Object) -> None:
    other = build_character(named("Other"))
    for each, selected in ((rig, True), (other, False)):
        each.select_set(selected)
    bpy.context.view_layer.objects.active = rig
    assert bpy.ops.keymark.add_character() == {"FINISHED"}
    character = take.characters[0]
    assert character.armature == rig and character.problem == ""
    assert character.character_map.roles["forearm.L"].bones[0].bone == "forearm.L"
    assert [entry.bone for entry in character.character_map.roles["spine"].bones] == ["spine", "chest"]
    rig.select_set(False)
    assert candidates(bpy.context.scene, bpy.context.view_layer) == [other]


def test_the_only_armature_is_added_without_being_selected(take: PropertyGroup, rig: Object) -> None:
    rig.select_set(False)
    bpy.context.view_layer.objects.active = take.armature
    take.armature.select_set(True)
    assert bpy.ops.keymark.add_character() == {"FINISHED"}
    assert take.characters[0].armature == rig


def test_without_a_choice_the_field_is_left_to_the_person(take: PropertyGroup) -> None:
    for name in ("One", "Two"):
        build_character(named(name)).select_set(False)
    bpy.context.view_layer.objects.active = None
    assert bpy.ops.keymark.add_character() == {"FINISHED"}
    assert take.characters[0].armature is None
    with pytest.raises(RuntimeError, match="Choose the character's armature first"):
        bpy.ops.keymark.retarget()


def test_an_actor_is_no_character_and_a_character_no_actor(take: PropertyGroup, rig: Object) -> None:
    bpy.ops.keymark.add_character(armature=rig.name)
    character, mesh = take.characters[0], bpy.data.objects.new("Cube", bpy.data.meshes.new("Cube"))
    other = build_armature(bpy.context.scene, Body(Actor.from_stature(1.5)))
    assert accepts(character, "armature", rig) and accepts(take, "armature", other)
    for wrong in (take.armature, other, mesh):
        assert not accepts(character, "armature", wrong)
    for wrong in (rig, mesh):
        assert not accepts(take, "armature", wrong)
    take.armature.data.bones["hand.L"].name = "lost"
    assert not may_be_character(take.armature)
    with pytest.raises(RuntimeError, match="no armature of a character"):
        bpy.ops.keymark.add_character(armature=take.armature.name)


def test_a_script_that_gives_a_take_another_armature_is_told(take: PropertyGroup, rig: Object) -> None:
    take.armature = rig
    for operator in (bpy.ops.keymark.bake_motion, bpy.ops.keymark.show_action):
        with pytest.raises(
            RuntimeError, match=r"'Character' is no actor of Keymark's, as it lacks pelvis, girdle\.L"
        ):
            operator()


def test_what_is_no_character_is_said_and_stays_chosen(take: PropertyGroup) -> None:
    bones = plain_character().bones[:2]
    post = build_character(Character("Post", bones))
    character = take.characters.add()
    character.armature = post
    assert "Post" in character.problem and len(character.character_map.roles) == 0
    with pytest.raises(RuntimeError, match="Post"):
        bpy.ops.keymark.recognize_character()
    with pytest.raises(RuntimeError, match="Recognize the character's bones first"):
        bpy.ops.keymark.retarget()


def test_several_characters_are_added_and_removed(take: PropertyGroup, rig: Object) -> None:
    second = build_character(named("Second"))
    for each in (rig, second):
        bpy.ops.keymark.add_character(armature=each.name)
    assert take.active_character == 1
    take.characters[1].character_map.roles["hand.L"].bones[0].bone = "finger.L"
    assert take.characters[0].character_map.roles["hand.L"].bones[0].bone == "hand.L"
    bpy.ops.keymark.remove_character()
    assert [each.armature for each in take.characters] == [rig] and take.active_character == 0
    bpy.ops.keymark.remove_character()
    assert len(take.characters) == 0 and {rig, second} <= set(bpy.data.objects)
    with pytest.raises(RuntimeError, match="Add a character first"):
        bpy.ops.keymark.remove_character()


def test_another_take_knows_what_was_corrected(character: PropertyGroup, rig: Object) -> None:
    character.character_map.roles["hand.L"].bones[0].bone = "finger.L"
    other = add_take(bpy.context.scene, "Jump")
    other.characters.add().armature = rig
    found = other.characters[0].character_map.roles["hand.L"]
    assert (found.bones[0].bone, found.source) == ("finger.L", "you")


def test_removed_and_renamed_things_are_said(character: PropertyGroup, tmp_path: Path) -> None:
    armature = character.armature
    armature.data.bones["shin.L"].name = "Unterschenkel"
    with pytest.raises(RuntimeError, match=r"has no bone 'shin\.L' any more"):
        bpy.ops.keymark.retarget()
    character.character_map.roles["shin.L"].bones[0].bone = ""
    with pytest.raises(RuntimeError, match="Choose the bones of left shin first"):
        bpy.ops.keymark.retarget()
    bpy.context.scene.collection.objects.unlink(armature)
    with pytest.raises(RuntimeError, match="'Character' is not in this scene"):
        bpy.ops.keymark.retarget()
    bpy.data.objects.remove(armature)
    with pytest.raises(RuntimeError, match="Choose the character's armature first"):
        bpy.ops.keymark.retarget()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "lost.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "lost.blend"))
    assert active_take(bpy.context.scene).characters[0].armature is None
