"""Retargeting by its button: what becomes of earlier results, of a newer motion, and of Esc."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from _armatures import build_character, move_a_key
from _characters import plain_character
from _scene_state import assert_undoable, differences, scene_state
from bpy.types import Action, Object, PropertyGroup, Scene
from keymark.core.errors import InputError
from keymark.core.progress import run
from keymark.core.retarget.character import Character
from keymark.core.retarget.quality import Quality
from keymark.operators.bridge.actions import curve_digest
from keymark.operators.bridge.actor_bones import moves_an_actor
from keymark.operators.character.characters import source_of
from keymark.operators.character.retarget import figures
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


def shown(character: PropertyGroup) -> Action:
    """The Action that animates a character."""
    return character.armature.animation_data.action


def test_the_motion_becomes_an_action_of_the_character(character: PropertyGroup, take: PropertyGroup) -> None:
    bpy.context.scene.frame_set(7)
    before = curve_digest(take.armature)
    assert bpy.ops.keymark.retarget() == {"FINISHED"}
    action = shown(character)
    assert action.name == "Walk Character" and action.use_fake_user
    assert character.armature.animation_data.action_slot in list(action.slots)
    assert [each.action for each in character.results] == [action]
    assert character.results[0].source_action == take.motion_action
    assert curve_digest(take.armature) == before and bpy.context.scene.frame_current == 7
    bone = character.armature.pose.bones["thigh.L"]
    rested = np.array(bone.matrix)
    bpy.context.scene.frame_set(11)
    assert np.abs(np.array(bone.matrix) - rested).max() > 1e-3


def test_again_replaces_only_what_it_made(character: PropertyGroup, take: PropertyGroup) -> None:
    bpy.ops.keymark.retarget()
    first, count = shown(character), len(bpy.data.actions)
    bpy.ops.keymark.retarget()
    assert shown(character) == first and len(bpy.data.actions) == count
    character.keep_earlier = True
    bpy.ops.keymark.retarget()
    second = shown(character)
    assert second != first and [each.action for each in character.results] == [first, second]
    bpy.ops.keymark.show_result(index=0)
    assert shown(character) == first and character.active_result == 0
    character.keep_earlier = False
    bpy.ops.keymark.retarget()  # the one that is chosen is replaced
    assert shown(character) == first and len(character.results) == 2
    with pytest.raises(RuntimeError, match="no result number 5"):
        bpy.ops.keymark.show_result(index=5)
    bpy.ops.keymark.remove_result(index=0)
    assert [each.action for each in character.results] == [second] and first in list(bpy.data.actions)


def test_a_result_that_was_deleted_is_made_anew(character: PropertyGroup) -> None:
    bpy.ops.keymark.retarget()
    bpy.data.actions.remove(shown(character))
    assert character.results[0].action is None
    with pytest.raises(RuntimeError, match="Retarget the motion first"):
        bpy.ops.keymark.show_result()
    bpy.ops.keymark.retarget()
    assert [each.action for each in character.results] == [shown(character)]


def test_another_armature_begins_without_results(character: PropertyGroup) -> None:
    bpy.ops.keymark.retarget()
    first, before = character.armature, shown(character)
    digest = curve_digest(first)
    character.armature = first
    assert [each.action for each in character.results] == [before]
    character.armature = build_character(Character("Second", plain_character().bones))
    assert len(character.results) == 0
    bpy.ops.keymark.retarget()
    assert shown(character).name == "Walk Second" and curve_digest(first) == digest


def test_the_newest_motion_is_performed(character: PropertyGroup, take: PropertyGroup) -> None:
    assert source_of(take, character).kind == "MOTION"
    bpy.ops.keymark.bake_motion()
    assert source_of(take, character).action == take.finish.action
    take.finish.made_from = "earlier"
    assert source_of(take, character).action == take.motion_action
    character.source = "FINAL"
    assert source_of(take, character).action == take.finish.action
    take.finish.action = None
    with pytest.raises(RuntimeError, match="Bake the final Action first"):
        bpy.ops.keymark.retarget()


def test_a_newer_motion_marks_the_result(opened: Scene) -> None:
    take = active_take(opened)
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    bpy.ops.keymark.add_character(armature=build_character(plain_character()).name)
    character = active_take(opened).characters[0]
    for newer in (lambda: move_a_key(take.motion_action), bpy.ops.keymark.bake_motion):
        bpy.ops.keymark.retarget()
        assert not TakeState(take).of_earlier(character.results[0])
        newer()
        assert TakeState(take).of_earlier(character.results[0])
    bpy.ops.keymark.retarget()
    assert not TakeState(take).of_earlier(character.results[0]) and len(character.results) == 1


def turned(armature: bpy.types.Object, frames: range) -> np.ndarray:
    """(F, B, 3, 3) rotations of an armature's bones in the world."""
    shown = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        world = [(armature.matrix_world @ bone.matrix).to_quaternion() for bone in armature.pose.bones]
        shown.append([np.array(turn.to_matrix()) for turn in world])
    return np.array(shown)


def test_a_file_has_whom_one_sees(character: PropertyGroup, take: PropertyGroup, tmp_path: Path) -> None:
    assert take.finish.who == take.armature.name  # nobody else performs yet
    bpy.ops.keymark.retarget()
    rig, frames = character.armature, range(1, 21)
    assert take.finish.who == rig.name
    skin = bpy.data.objects.new("Skin", bpy.data.meshes.new("Skin"))
    bpy.context.scene.collection.objects.link(skin)
    skin.modifiers.new("Armature", "ARMATURE").object = rig
    assert bpy.ops.keymark.export_motion(format="FBX", filepath=str(tmp_path / "who.fbx")) == {"FINISHED"}
    assert take.finish.action is None  # the actor's is not wanted
    wanted, known = turned(rig, frames), set(bpy.data.objects)
    bpy.ops.import_scene.fbx(filepath=str(tmp_path / "who.fbx"), anim_offset=0.0)
    made = {each.type: each for each in bpy.data.objects if each not in known}
    assert set(made) == {"ARMATURE", "MESH"}
    assert [bone.name for bone in made["ARMATURE"].pose.bones] == [bone.name for bone in rig.pose.bones]
    since_first = [all_ @ np.swapaxes(all_[0], -1, -2) for all_ in (wanted, turned(made["ARMATURE"], frames))]
    trace = np.einsum("fbij,fbij->fb", *since_first)  # importers turn rest poses, which cancels
    assert np.degrees(np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0))).max() < 1.0
    assert np.ptp(since_first[0], axis=0).max() > 0.2
    take.finish.who = take.armature.name
    for named, who in (("", take.armature.name), (rig.name, rig.name)):
        bpy.ops.keymark.export_motion(format="BVH", who=named, filepath=str(tmp_path / "who.bvh"))
        joints = (tmp_path / "who.bvh").read_text().count("JOINT") + 1
        assert joints == len(bpy.data.objects[who].data.bones)
    assert not TakeState(take).final_is_outdated and take.finish.action is not None  # baked for the file
    with pytest.raises(RuntimeError, match=r"'Nobody' performs nothing; valid is .*Walk Actor"):
        bpy.ops.keymark.export_motion(format="BVH", who="Nobody", filepath=str(tmp_path / "who.bvh"))


def test_one_button_makes_all_of_a_correction(opened: Scene) -> None:
    take = active_take(opened)
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    bpy.ops.keymark.bake_motion()
    bpy.ops.keymark.add_character(armature=build_character(plain_character()).name)
    bpy.ops.keymark.retarget()
    with pytest.raises(RuntimeError, match="Everything is up to date"):
        bpy.ops.keymark.update()
    rig = take.characters[0].armature
    before = [curve_digest(each) for each in (take.armature, rig)]
    move_a_key(take.keyframe_action)
    assert TakeState(take).next == ("keyframes", "correct more, or update")
    assert_undoable([("updating", bpy.ops.keymark.update)])
    take = active_take(bpy.context.scene)
    rig = take.characters[0].armature
    assert not TakeState(take).is_outdated and len(take.characters[0].results) == 1
    assert take.armature.animation_data.action == take.finish.action
    assert not {curve_digest(take.armature), curve_digest(rig)} & set(before)


def test_any_action_of_an_actor_is_performed(character: PropertyGroup, take: PropertyGroup) -> None:
    bpy.ops.keymark.retarget()
    other = take.motion_action.copy()
    other.name = "Jump"
    assert moves_an_actor(other) and not moves_an_actor(shown(character))
    character.source = "ACTION"
    with pytest.raises(RuntimeError, match="Choose the Action that the character is to perform"):
        bpy.ops.keymark.retarget()
    character.source_action = other
    bpy.ops.keymark.retarget()
    assert [each.action.name for each in character.results] == ["Walk Character", "Jump Character"]
    assert character.results[1].source_actor == take.armature
    bpy.ops.keymark.bake_motion()
    assert [TakeState(take).of_earlier(each) for each in character.results] == [True, False]
    bpy.ops.keymark.retarget()
    assert len(character.results) == 2
    character.source_actor = character.armature
    with pytest.raises(RuntimeError, match="'Character' is no actor of Keymark's"):
        bpy.ops.keymark.retarget()


def test_an_action_that_is_not_the_actors_changes_nothing(character: PropertyGroup) -> None:
    before = scene_state()
    foreign = bpy.data.actions.new("Foreign")
    character.source, character.source_action = "ACTION", foreign
    with pytest.raises(RuntimeError, match="'Foreign' has no motion of 'Walk Actor'"):
        bpy.ops.keymark.retarget()
    character.property_unset("source")
    character.source_action = None
    bpy.data.actions.remove(foreign)
    assert not differences(before, scene_state())


def test_each_of_several_characters_has_results_of_its_own(
    character: PropertyGroup, take: PropertyGroup
) -> None:
    second = build_character(Character("Second", plain_character().bones))
    bpy.ops.keymark.add_character(armature=second.name)
    for number in (1, 0):
        take.active_character = number
        bpy.ops.keymark.retarget()
    actions = [each.results[0].action for each in take.characters]
    assert [action.name for action in actions] == ["Walk Character", "Walk Second"]
    assert [shown(each) for each in take.characters] == actions
    take.active_character = 1
    bpy.ops.keymark.retarget()
    assert [each.results[0].action for each in take.characters] == actions


def test_a_cancelled_job_leaves_no_trace(character: PropertyGroup) -> None:
    from keymark.operators.character.retarget import KEYMARK_OT_retarget

    before = scene_state()
    total = sum(1 for _ in KEYMARK_OT_retarget.start(None, bpy.context.scene))
    for steps in (1, total // 3, 2 * total // 3, total - 1):
        job = KEYMARK_OT_retarget.start(None, bpy.context.scene)
        for _ in range(steps):
            next(job)
        job.close()
        assert not differences(before, scene_state()), f"after {steps} of {total} steps"


def test_what_is_removed_while_the_job_runs_is_said(character: PropertyGroup, take: PropertyGroup) -> None:
    from keymark.operators.character.retarget import KEYMARK_OT_retarget

    scene = bpy.context.scene
    result = run(KEYMARK_OT_retarget.start(None, scene))
    character.armature = None
    with pytest.raises(InputError, match="was removed while the job ran; nothing was changed"):
        KEYMARK_OT_retarget.finish(None, scene, result)
    bpy.ops.keymark.remove_character()
    with pytest.raises(InputError, match="was removed while the job ran"):
        KEYMARK_OT_retarget.finish(None, scene, result)
    assert list(bpy.data.actions) == [take.motion_action]


def test_every_step_is_undone_and_redone(take: PropertyGroup, rig: Object) -> None:
    ops = bpy.ops.keymark
    steps: list[tuple[str, Callable[[], object]]] = [
        ("add", lambda: ops.add_character(armature="Character")),
        ("pick", lambda: ops.pick_bone(role="hand.L", bone="finger.L")),
        ("mirror", ops.mirror_roles),
        ("recognize", ops.recognize_character),
        ("retarget", ops.retarget),
        ("keep", lambda: setattr(active_take(bpy.context.scene).characters[0], "keep_earlier", True)),
        ("another", ops.retarget),
        ("show", lambda: ops.show_result(index=0)),
        ("remove result", lambda: ops.remove_result(index=1)),
        ("remove", ops.remove_character),
    ]
    assert_undoable(steps)


def test_the_result_is_an_asset_like_the_actors(character: PropertyGroup, take: PropertyGroup) -> None:
    bpy.ops.keymark.retarget()
    take.finish.catalog, take.finish.tags, take.finish.author = "", "walk, calm", "Ann"
    assert bpy.ops.keymark.mark_result_asset() == {"FINISHED"}
    data = shown(character).asset_data
    assert sorted(tag.name for tag in data.tags) == ["calm", "walk"] and data.author == "Ann"
    assert tuple(shown(character).preview.image_size) == (256, 256)
    assert take.motion_action.asset_data is None


def test_removing_a_take_with_its_data_keeps_the_character(character: PropertyGroup, rig: Object) -> None:
    bpy.ops.keymark.retarget()
    bpy.ops.keymark.remove_take(delete_data=True)
    assert list(bpy.data.actions) == [] and rig in list(bpy.data.objects)


def test_the_figures_of_a_motion_in_words() -> None:
    quality = Quality(
        arms_deg=0.04, legs_deg=2.26, skate_mm=0.021, penetration_mm=1.06, keys=12, dense_keys=90
    )
    assert figures(quality) == [
        "Feet slide 0.02 mm a frame",
        "Soles at most 1.1 mm below floor",
        "Arms 0.0°, legs 2.3° off",
        "12 keys instead of 90",
    ]
    assert figures(replace(quality, hands_mm=6.4))[2] == "Hands 6 mm from what they reach"
    assert figures(Quality()) == []
