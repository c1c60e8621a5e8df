"""A found keyframe that is corrected is posed from then on, and those around it are found anew."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _posed import posture_of
from _scene_state import differences, scene_state
from keymark.core.body.human import HUMAN
from keymark.operators.bridge.object_space import joint_places
from keymark.operators.shell.keyed_frames import matched_frames, posed_frames
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


def test_a_dragged_joint_of_a_found_keyframe_stays_and_improves_its_neighbors(
    found: bpy.types.PropertyGroup, given: SimpleNamespace
) -> None:
    """In one step of undo."""
    scene = bpy.context.scene
    scene.frame_set(7)
    bpy.ops.ed.undo_push(message="Opened")
    before, asked = scene_state(), len(given.frames)
    place = joint_places(found.armature)[HUMAN.point_names.index("wrist.L")] + [0.05, 0.0, 0.05]
    bpy.ops.keymark.move_joint(joint="wrist.L", place=place, sight=(0.0, 1.0, 0.0))
    bpy.ops.ed.undo_push(message="Moved")
    take = active_take(scene)
    assert posed_frames(take) == (7.0,)
    assert matched_frames(take) == (1.0, 13.0)
    assert given.frames[asked:] == [(0, 12)]
    reached = joint_places(take.armature)[HUMAN.point_names.index("wrist.L")]
    np.testing.assert_allclose(reached[[0, 2]], place[[0, 2]], atol=3e-3)
    bpy.ops.ed.undo()
    assert not differences(before, scene_state())


def test_a_turned_found_keyframe_is_posed(found: bpy.types.PropertyGroup, given: SimpleNamespace) -> None:
    """Turn, too, decides on a keyframe."""
    bpy.context.scene.frame_set(13)
    before = posture_of(bpy.context.scene)
    bpy.ops.keymark.turn_performer(facing="AWAY", fit=False)
    assert posed_frames(active_take(bpy.context.scene)) == (13.0,)
    assert np.abs(posture_of(bpy.context.scene).minus(before)).max() > 0.5
