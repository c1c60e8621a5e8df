"""Notices at a step: they stay until they are untrue."""

import bpy
import pytest
from keymark.operators.shell.notices import give_notices, notices_of
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


def test_newer_notices_replace_those_about_the_same(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    give_notices(take, "finish", "bake", ("the left foot slides", "the right one too"))
    give_notices(take, "finish", "asset", ("no catalog",))
    assert notices_of(take, "finish") == ["the left foot slides", "the right one too", "no catalog"]
    give_notices(take, "finish", "bake", ("the left foot slides less",))
    assert notices_of(take, "finish") == ["no catalog", "the left foot slides less"]
    give_notices(take, "finish", "bake")
    assert notices_of(take, "finish") == ["no catalog"] and notices_of(take, "review") == []


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
        said = notices_of(take, "keyframes")
        assert len(said) == (turned > 0.0)
        assert all("beyond what the skeleton can do" in sentence for sentence in said)
    thigh.rotation_mode = mode
    give_notices(take, "keyframes", "pose at 5", ("of a key",), frame=5.0)
    give_notices(take, "keyframes", "pose at 6", ("of no key",), frame=6.0)
    assert notices_of(take, "keyframes") == ["of a key"]
