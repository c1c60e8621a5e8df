"""Notices at a step: they stay until they are untrue or dismissed."""

import bpy
import pytest
from keymark.core.take.take import Take
from keymark.operators.shell.notices import give_notices, notices_of
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


def sentences(take: bpy.types.PropertyGroup, step: str) -> list[str]:
    """The sentences that hold."""
    return [text for _, text in notices_of(take, step)]


def test_newer_notices_replace_those_about_the_same(opened: bpy.types.Scene) -> None:
    """Others stay; none given means that there is nothing to know any more."""
    take = active_take(opened)
    give_notices(take, "finish", "bake", ("the left foot slides", "the right one too"))
    give_notices(take, "finish", "asset", ("no catalog",))
    assert sentences(take, "finish") == ["the left foot slides", "the right one too", "no catalog"]
    give_notices(take, "finish", "bake", ("the left foot slides less",))
    assert sentences(take, "finish") == ["no catalog", "the left foot slides less"]
    give_notices(take, "finish", "bake")
    assert sentences(take, "finish") == ["no catalog"] and sentences(take, "review") == []


def test_a_notice_is_dismissed_by_its_button(opened: bpy.types.Scene) -> None:
    """One that is not there is an error."""
    take = active_take(opened)
    give_notices(take, "finish", "bake", ("first", "second"))
    bpy.ops.keymark.dismiss_notice(index=notices_of(take, "finish")[0][0])
    assert sentences(take, "finish") == ["second"]
    with pytest.raises(RuntimeError, match="Index is 9"):
        bpy.ops.keymark.dismiss_notice(index=9)


def test_what_hides_the_footage_is_said_until_it_is_hidden(tiny_take: Take) -> None:
    """A cube stands before the performer."""
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    camera = active_take(bpy.context.scene).camera
    bpy.ops.mesh.primitive_cube_add(location=camera.matrix_world @ camera.location.lerp((0, 0, -4), 1.0))
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    take = active_take(bpy.context.scene)
    (sentence,) = sentences(take, "footage")
    assert sentence.startswith("In front of the footage: Cube")
    bpy.data.objects["Cube"].hide_set(True)
    assert sentences(take, "footage") == []


def test_a_pose_beyond_the_skeleton_is_said_while_it_is_keyed(opened: bpy.types.Scene) -> None:
    """Deleting the key ends it, and so does another pose there."""
    take = active_take(opened)
    opened.frame_set(5)
    thigh = take.armature.pose.bones["thigh.L"]
    mode = thigh.rotation_mode
    for turned in (2.0, 0.0):
        thigh.rotation_mode, thigh.rotation_euler = "XYZ", (0.0, 0.0, 0.0)
        thigh.scale = (1.0, 1.0 + turned, 1.0)
        bpy.context.view_layer.update()
        bpy.ops.keymark.store_keyframe()
        said = sentences(take, "keyframes")
        assert len(said) == (turned > 0.0)
        assert all("beyond what the skeleton can do" in sentence for sentence in said)
    thigh.rotation_mode = mode
    give_notices(take, "keyframes", "pose at 5", ("of a key",), frame=5.0)
    give_notices(take, "keyframes", "pose at 6", ("of no key",), frame=6.0)
    assert sentences(take, "keyframes") == ["of a key"]
