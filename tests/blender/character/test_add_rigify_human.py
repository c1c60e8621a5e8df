"""Add Rigify Human: a rig of the performer's size, recognized, and nothing else left behind."""

from pathlib import Path
from types import SimpleNamespace

import _add_rigify_human
import bpy
import pytest
from _armatures import run_script
from bpy.types import Object, PropertyGroup
from keymark.operators.bridge.character import rigify_human
from keymark.operators.character import add_character as add_rigify_human
from keymark.operators.character.characters import recognized
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file in which the button was clicked twice."""
    path = tmp_path_factory.mktemp("rigify") / "added.blend"
    run_script(Path(_add_rigify_human.__file__), path)
    return path


def height_m(rig: Object) -> float:
    """Height of the top of the head above the floor."""
    return max((rig.matrix_world @ bone.tail_local).z for bone in rig.data.bones if bone.use_deform)


def test_the_rigs_are_the_performers_size_and_recognized(file: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(file), use_scripts=False)
    take = active_take(bpy.context.scene)
    assert [each.armature.name for each in take.characters] == ["Human", "Human.001"]
    assert take.active_character == 1
    for number, character in enumerate(take.characters):
        rig = character.armature
        assert height_m(rig) == pytest.approx(take.stature, abs=0.01)
        assert rig.matrix_world.translation.length < 1e-6
        assert character.problem == "" and not len(character.doubts)
        assert character.character_map.preset == "rigify"
        take.active_character = number
        assert recognized(bpy.context, None) is None
    assert not bpy.ops.keymark.retarget.poll()  # nothing but the motion is missing yet
    assert bpy.context.view_layer.objects.active.mode == "OBJECT"


def test_each_rig_has_its_own_body_and_no_metarig_is_left(file: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(file), use_scripts=False)
    take = active_take(bpy.context.scene)
    rigs = [each.armature for each in take.characters]
    armatures = {each for each in bpy.context.scene.objects if each.type == "ARMATURE"}
    assert armatures == {take.armature, *rigs}
    for rig in rigs:
        (body,) = (each for each in rig.children if each.type == "MESH")
        assert body.modifiers["Armature"].object == rig
        assert body.dimensions.z == pytest.approx(height_m(rig), rel=0.12)


def test_without_a_take_there_is_nothing_to_add_it_to() -> None:
    with pytest.raises(RuntimeError, match="Load the footage or open a take first"):
        bpy.ops.keymark.add_rigify_human()


def test_a_blender_without_rigify_says_so(take: PropertyGroup, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(add_rigify_human, "has_rigify", lambda: False)
    with pytest.raises(RuntimeError, match="comes without the add-on Rigify"):
        bpy.ops.keymark.add_rigify_human()


def test_where_rigify_fails_nothing_is_left(take: PropertyGroup, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail() -> None:
        bpy.ops.object.armature_add()
        raise RuntimeError("Error: Unknown rig type")

    monkeypatch.setattr(add_rigify_human, "is_rigify_enabled", lambda: True)
    failing = SimpleNamespace(object=SimpleNamespace(armature_basic_human_metarig_add=fail))
    monkeypatch.setattr(rigify_human, "bpy", SimpleNamespace(ops=failing, data=bpy.data))
    before = set(bpy.data.objects)
    with pytest.raises(RuntimeError, match=r"make the rig \(Unknown rig type\); add one by Add > Armature"):
        bpy.ops.keymark.add_rigify_human()
    assert set(bpy.data.objects) == before and not len(take.characters)
