"""Characters from files: the armature and what belongs to it; nothing stays in the open file."""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import bpy
import pytest
from _armatures import build_character
from _character_glb import write_glb, write_gltf
from _characters import plain_character
from keymark.core.errors import InputError
from keymark.core.take.conversion_settings import CharacterFile
from keymark.operators.bridge.blend_files import own_scene
from keymark.operators.bridge.character.import_character import ImportedCharacter, import_character

Import = Callable[[str], ImportedCharacter]


def skin(armature: bpy.types.Object, name: str) -> bpy.types.Object:
    """A mesh on a bone of an armature that is not its child."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(0, 0, 1), (0.1, 0, 1), (0, 0.1, 1.3)], [], [(0, 1, 2)])
    skinned = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(skinned)
    skinned.vertex_groups.new(name="hips").add([0, 1, 2], 1.0, "REPLACE")
    skinned.modifiers.new("Armature", "ARMATURE").object = armature
    return skinned


def add_character(name: str = "Anna") -> bpy.types.Object:
    """A character with a skin, a sword on its hand, a helper for the skin and a widget."""
    scene = bpy.context.scene
    armature = build_character(plain_character(root="root"))
    armature.name = name
    body = skin(armature, f"{name} body")
    helper, sword, widget = (
        bpy.data.objects.new(f"{name} {what}", None) for what in ("helper", "sword", "widget")
    )
    for one in (helper, sword):
        scene.collection.objects.link(one)
    body.modifiers.new("Cast", "CAST").object = helper
    sword.constraints.new("CHILD_OF").target = armature
    armature.pose.bones["hips"].custom_shape = widget
    return armature


@pytest.fixture(scope="module")
def cast(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A character in every kind of file, and other files; tests must not change them."""
    made = tmp_path_factory.mktemp("cast")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    armature = add_character()
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Table", None))
    bpy.data.texts.new("rig_ui.py").use_module = True
    bpy.data.texts.new("notes")
    armature.keyframe_insert("location", frame=1)
    bpy.ops.wm.save_as_mainfile(filepath=str(made / "anna.blend"))
    for one in bpy.context.scene.objects:
        one.select_set(one.name in ("Anna", "Anna body"))
    bpy.ops.export_scene.fbx(filepath=str(made / "anna.fbx"), use_selection=True)
    anna = replace(plain_character(root="root"), name="Anna")
    write_gltf(anna, made / "anna.gltf")
    for name in ("anna.glb", "anna.vrm"):
        write_glb(anna, made / name)
    add_character("Ben")
    bpy.ops.wm.save_as_mainfile(filepath=str(made / "two.blend"))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(made / "none.blend"))
    for suffix in (".blend", ".glb", ".gltf", ".fbx", ".vrm"):
        (made / f"damaged{suffix}").write_bytes(b"BLENDER-v405RENDH" + bytes(range(256)) * 4)
        whole = (made / f"anna{suffix}").read_bytes()
        (made / f"half{suffix}").write_bytes(whole[: len(whole) // 2])
        (made / f"empty{suffix}").write_bytes(b"")
    (made / "folder.blend").mkdir()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return made


@pytest.fixture
def folder(cast: Path, tmp_path: Path) -> Path:
    """A copy of them for one test."""
    return Path(shutil.copytree(cast, tmp_path / "cast"))


@pytest.fixture
def imported(folder: Path) -> Iterator[Import]:
    """A function that imports a character of the folder; afterwards nothing of it is left."""
    own = bpy.data.objects.new("Anna", None)
    bpy.context.scene.collection.objects.link(own)
    before, scene = set(bpy.data.user_map()), bpy.context.scene
    with own_scene("Import") as empty:
        yield lambda text: import_character(CharacterFile.parse(str(folder / text)), empty)
    assert set(bpy.data.user_map()) == before
    assert bpy.context.scene == scene and list(scene.objects) == [own]


def names(character: ImportedCharacter) -> set[str]:
    """Names of the objects in the character's scene, without numbers."""
    (scene,) = character.armature.users_scene
    assert set(scene.objects) == set(character.objects)
    (collection,) = scene.collection.children
    assert set(collection.objects) == set(character.objects)
    return {one.name.removesuffix(".001") for one in character.objects}


def test_a_blend_gives_the_character_with_all_it_needs(imported: Import) -> None:
    character = imported("anna.blend")
    assert names(character) == {"Anna", "Anna body", "Anna helper", "Anna sword"}
    assert character.armature.pose.bones["hips"].custom_shape.name == "Anna widget"
    assert [text.name for text in character.texts] == ["rig_ui.py"]
    assert character.notes == ()


@pytest.mark.parametrize("file", ["anna.glb", "anna.gltf", "anna.fbx", "anna.vrm"])
def test_exchange_files_give_the_same_bones(imported: Import, file: str) -> None:
    character = imported(file)
    assert len(names(character)) == 2 and "Anna" in names(character)
    assert set(plain_character(root="root").index) <= {bone.name for bone in character.armature.data.bones}
    data = character.armature.animation_data
    assert data is None or (data.action is None and not data.nla_tracks)
    assert all(bone.matrix_basis.is_identity for bone in character.armature.pose.bones)


@pytest.mark.parametrize("name", ["Anna", "Ben"])
def test_one_of_two_is_named(imported: Import, name: str) -> None:
    character = imported(f"two.blend:{name}")
    assert names(character) == {name, *(f"{name} {what}" for what in ("body", "helper", "sword"))}


def test_tracks_that_would_play_below_are_muted(imported: Import, folder: Path) -> None:
    armature = add_character("Carl")
    action = bpy.data.actions.new("Idle")
    armature.animation_data_create().nla_tracks.new().strips.new("Idle", 1, action)
    bpy.data.libraries.write(str(folder / "carl.blend"), {armature}, fake_user=True)
    bpy.data.batch_remove([*(o for o in bpy.data.objects if o.name.startswith("Carl")), action])
    bpy.data.batch_remove([*bpy.data.armatures, *bpy.data.meshes])
    character = imported("carl.blend")
    assert all(track.mute for track in character.armature.animation_data.nla_tracks)
    assert character.notes[0].startswith("NLA tracks of 'Carl' are muted in the copy: 'NlaTrack'")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("nowhere.blend", "no such file; it must be a character file"),
        ("folder.blend", "is a folder, no file"),
        ("none.blend", "holds no armature; a character is an armature with the meshes"),
        ("two.blend", "holds 2 armatures, 'Anna', 'Ben'; name one, as in .*two.blend:Anna"),
        ("two.blend:Carl", "'Carl' is not in it; its armatures are 'Anna', 'Ben'"),
        ("anna.blend:Anna body", "'Anna body' is no armature; its armatures are 'Anna'"),
        ("anna.glb:Ben", "'Ben' is not in it; its armatures are 'Anna'"),
        *((f"damaged{suffix}", "cannot read") for suffix in (".blend", ".glb", ".gltf", ".fbx", ".vrm")),
        *((f"half{suffix}", "cannot read") for suffix in (".blend", ".glb", ".gltf", ".fbx", ".vrm")),
        *((f"empty{suffix}", "cannot read|is no .blend") for suffix in (".blend", ".glb", ".gltf", ".fbx")),
    ],
)
def test_what_is_no_character_is_one_sentence(imported: Import, text: str, said: str) -> None:
    with pytest.raises(InputError, match=said) as caught:
        imported(text)
    sentence = str(caught.value)
    assert len(sentence.splitlines()) == 1 and text.partition(":")[0] in sentence and len(sentence) < 500


def test_a_file_of_another_program_is_read(imported: Import, folder: Path) -> None:
    write_glb(plain_character(scale=0.01), folder / "plain.glb")
    character = imported("plain.glb")
    armature = character.armature
    for bone in plain_character().bones:
        head = armature.matrix_world @ armature.data.bones[bone.name].head_local
        assert tuple(head) == pytest.approx(tuple(bone.head), abs=1e-5)
