"""Which steps are folded in the sidebar."""

import bpy
import pytest
from keymark.core.take.take import Take
from keymark.operators.shell.steps import STEPS, is_open
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


def folded(take: bpy.types.PropertyGroup) -> set[str]:
    return {step for step in STEPS if not is_open(take, step)}


def test_steps_fold_once_the_work_has_left_them_behind(tiny_take: Take) -> None:
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    take = active_take(bpy.context.scene)
    assert folded(take) == set()
    bpy.ops.keymark.add_marker()
    assert folded(take) == set()
    take.markers[0].color = (0.1, 0.5, 0.2)
    assert folded(take) == set()
    bpy.ops.keymark.keep_camera()
    assert folded(take) == {"footage"}
    bpy.ops.keymark.build_actor()
    assert folded(take) == {"footage"}
    bpy.ops.keymark.store_keyframe()
    begun = {"footage", "follow", "actor"}
    assert folded(take) == begun
    take.motion_action = bpy.data.actions.new("Motion")
    assert folded(take) == begun
    take.finish.action = bpy.data.actions.new("Final")
    assert folded(take) == begun | {"keyframes", "reconstruct", "review"}
    take.finish.outdated = True
    assert folded(take) == begun
    bpy.data.objects.remove(take.armature)
    assert folded(take) == {"footage", "follow"}
    take.clip_state.missing = True
    assert folded(take) == {"follow"}


def test_what_a_person_opens_stays_open_until_the_step_changes(opened: bpy.types.Scene) -> None:
    take, switches = active_take(opened), bpy.context.window_manager.keymark_steps
    assert not switches.actor and switches.finish
    switches.actor, switches.finish = True, False
    assert switches.actor and not switches.finish and "actor" not in folded(take)
    bpy.data.objects.remove(take.armature)
    assert switches.actor  # gone: open in any case
    bpy.ops.keymark.apply_lengths()
    assert switches.actor  # as it was opened
    bpy.ops.keymark.add_performer()
    assert switches.actor and switches.finish  # those of another take


def test_panels_inside_a_folded_step_are_hidden(opened: bpy.types.Scene) -> None:
    lengths = bpy.types.Panel.bl_rna_get_subclass_py("KEYMARK_PT_actor_lengths")
    markers = bpy.types.Panel.bl_rna_get_subclass_py("KEYMARK_PT_markers")
    step = bpy.types.Panel.bl_rna_get_subclass_py("KEYMARK_PT_actor")
    assert step.poll(bpy.context) and not lengths.poll(bpy.context) and not markers.poll(bpy.context)
    bpy.context.window_manager.keymark_steps.actor = True
    assert lengths.poll(bpy.context) and not markers.poll(bpy.context)
