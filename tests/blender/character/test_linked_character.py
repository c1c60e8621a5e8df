"""Characters that are linked from other files: an override is offered, made, and keeps its motion."""

from pathlib import Path

import bpy
import pytest
from _armatures import build_character
from _characters import plain_character
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def rig_file(tmp_path: Path) -> Path:
    """A .blend with the plain character in a collection."""
    rig = build_character(plain_character())
    collection = bpy.data.collections.new("Hero")
    collection.objects.link(rig)
    path = tmp_path / "hero.blend"
    bpy.data.libraries.write(str(path), {collection}, fake_user=True)
    bpy.data.batch_remove([collection, rig, rig.data])
    return path


def link_object(file: Path) -> bpy.types.Object:
    """The armature, linked and in the scene."""
    with bpy.data.libraries.load(str(file), link=True) as (_source, target):
        target.objects = ["Character"]
    bpy.context.scene.collection.objects.link(target.objects[0])
    return target.objects[0]


def link_instance(file: Path) -> bpy.types.Object:
    """The armature in a linked collection that an empty shows, as File > Link does it."""
    with bpy.data.libraries.load(str(file), link=True) as (_source, target):
        target.collections = ["Hero"]
    empty = bpy.data.objects.new("Hero", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", target.collections[0]
    bpy.context.scene.collection.objects.link(empty)
    return target.collections[0].objects[0]


@pytest.mark.parametrize("link", [link_object, link_instance])
def test_a_linked_character_is_overridden_and_performs(
    rig_file: Path, take: bpy.types.PropertyGroup, tmp_path: Path, link: object
) -> None:
    before = rig_file.read_bytes()
    linked = link(rig_file)  # type: ignore[operator]
    bpy.context.view_layer.update()
    bpy.context.view_layer.objects.active = None
    assert bpy.ops.keymark.add_character() == {"FINISHED"}
    assert take.characters[0].armature == linked
    with pytest.raises(RuntimeError, match="'Character' is linked; make a library override of it first"):
        bpy.ops.keymark.retarget()
    assert bpy.ops.keymark.make_override() == {"FINISHED"}
    character = take.characters[0]
    assert character.armature != linked and character.armature.override_library.reference == linked
    assert character.problem == "" and len(character.character_map.roles)
    with pytest.raises(RuntimeError, match="The character is not linked"):
        bpy.ops.keymark.make_override()
    assert bpy.ops.keymark.retarget() == {"FINISHED"}
    name = character.results[0].action.name
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "shot.blend"))
    again = active_take(bpy.context.scene).characters[0]
    assert again.armature.animation_data.action.name == name
    assert again.armature.animation_data.action_slot is not None
    assert rig_file.read_bytes() == before
