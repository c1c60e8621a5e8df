"""Which step is open in the sidebar, and the notices at it."""

import bpy
import pytest
from keymark.core.take.take import Take
from keymark.operators.shell.notes import give_notices
from keymark.operators.shell.panel import is_open
from keymark.operators.shell.take_state import STEPS, TakeState, digest_of
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


def opened_steps(take: bpy.types.PropertyGroup) -> list[str]:
    return [step for step in STEPS if is_open(take, step)]


def test_the_step_is_open_that_the_work_has_come_to(tiny_take: Take) -> None:
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    take = active_take(bpy.context.scene)
    assert opened_steps(take) == ["footage"]
    bpy.ops.keymark.keep_camera()
    assert opened_steps(take) == ["actor"]
    bpy.ops.keymark.build_actor()
    assert opened_steps(take) == ["keyframes"]
    bpy.ops.keymark.store_keyframe()
    assert opened_steps(take) == ["keyframes"]
    take.motion_action = bpy.data.actions.new("Motion")
    assert opened_steps(take) == ["reconstruct"]
    take.finish.action = bpy.data.actions.new("Final")
    take.finish.made_from = digest_of(take.motion_action)
    assert opened_steps(take) == ["character"]
    take.finish.made_from = "earlier"
    assert opened_steps(take) == ["reconstruct"]
    bpy.data.objects.remove(take.armature)
    assert opened_steps(take) == ["actor"]
    take.clip_state.missing = True
    assert opened_steps(take) == ["footage"]


def test_what_a_person_opens_folds_the_others_until_the_work_goes_on(opened: bpy.types.Scene) -> None:
    take, switches = active_take(opened), bpy.context.window_manager.keymark_steps
    assert opened_steps(take) == ["keyframes"]
    switches.finish = True
    assert opened_steps(take) == ["finish"]
    switches.actor = False  # it is folded already
    assert opened_steps(take) == ["finish"]
    switches.finish = False
    assert opened_steps(take) == []
    bpy.data.objects.remove(take.armature)
    assert opened_steps(take) == ["actor"]
    bpy.ops.keymark.apply_lengths()
    assert opened_steps(take) == []  # as it was left
    bpy.ops.keymark.add_performer()
    assert opened_steps(active_take(opened)) == ["actor"]  # of another take


def test_panels_inside_a_folded_step_are_hidden(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    take.characters.add().armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bones = bpy.types.Panel.bl_rna_get_subclass_py("KEYMARK_PT_character_map")
    step = bpy.types.Panel.bl_rna_get_subclass_py("KEYMARK_PT_character")
    assert step.poll(bpy.context) and not bones.poll(bpy.context)
    bpy.context.window_manager.keymark_steps.character = True
    assert bones.poll(bpy.context)


def test_newer_notices_replace_those_about_the_same(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    give_notices(take, "finish", "bake", ("the left foot slides", "the right one too"))
    give_notices(take, "finish", "asset", ("no catalog",))
    assert TakeState(take).notices("finish") == ["the left foot slides", "the right one too", "no catalog"]
    give_notices(take, "finish", "bake", ("the left foot slides less",))
    assert TakeState(take).notices("finish") == ["no catalog", "the left foot slides less"]
    give_notices(take, "finish", "bake")
    assert TakeState(take).notices("finish") == ["no catalog"] and TakeState(take).notices("review") == []


def test_a_pose_beyond_the_skeleton_is_said_while_it_is_keyed(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    opened.frame_set(5)
    thigh = take.armature.pose.bones["thigh.L"]
    mode = thigh.rotation_mode
    for turned in (2.0, 0.0):
        thigh.rotation_mode, thigh.rotation_euler = "XYZ", (0.0, 0.0, 0.0)
        thigh.scale = (1.0, 1.0 + turned, 1.0)
        bpy.context.view_layer.update()
        bpy.ops.keymark.store_keyframe()
        said = TakeState(take).notices("keyframes")
        assert len(said) == (turned > 0.0)
        assert all("beyond what the skeleton can do" in sentence for sentence in said)
    thigh.rotation_mode = mode
    give_notices(take, "keyframes", "pose at 5", ("of a key",), frame=5.0)
    give_notices(take, "keyframes", "pose at 6", ("of no key",), frame=6.0)
    assert TakeState(take).notices("keyframes") == ["of a key"]
