"""A character's map in properties: nothing is lost there, in the file, or by correcting one role."""

from pathlib import Path

import bpy
import pytest
from _characters import full_map
from keymark.core.retarget.character import LIMBS, ROLES
from keymark.core.retarget.maps.character_map import CharacterMap, RoleBones, read_character_map
from keymark.core.retarget.maps.presets import shipped_presets
from keymark.core.take.conversion_settings import RetargetOptions
from keymark.operators.character.map_properties import map_of, show_map
from keymark.operators.character.retarget import options_of
from keymark.operators.shell.takes import active_take

RIGIFY = next(one.character_map for one in shipped_presets() if one.identifier == "rigify")

pytestmark = pytest.mark.usefixtures("registered")


def role(character: bpy.types.PropertyGroup, name: str) -> bpy.types.PropertyGroup:
    """A role's properties."""
    return character.character_map.roles[name]


@pytest.mark.parametrize("character_map", [RIGIFY, full_map()], ids=["rigify", "full"])
def test_a_map_goes_into_properties_and_comes_back(
    character: bpy.types.PropertyGroup, character_map: CharacterMap
) -> None:
    for _ in range(2):
        show_map(character.character_map, character_map)
        assert map_of(character.character_map) == character_map
    assert [each.name for each in character.character_map.roles] == list(ROLES)
    assert [each.name for each in character.character_map.limbs] == list(LIMBS)


def test_the_map_is_in_the_file(character: bpy.types.PropertyGroup, tmp_path: Path) -> None:
    show_map(character.character_map, full_map())
    blend = tmp_path / "map.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    assert map_of(active_take(bpy.context.scene).characters[0].character_map) == full_map()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(blend)) as (source, target):
        target.scenes = source.scenes
    appended = active_take(target.scenes[0]).characters[0]
    assert map_of(appended.character_map) == full_map()
    assert appended.armature.name == "Character"


def test_the_defaults_are_cores(character: bpy.types.PropertyGroup) -> None:
    assert options_of(character.options) == RetargetOptions()
    character.options.keys, character.options.arms = "EVERY_FRAME", "FK"
    assert options_of(character.options).tolerance_m is None
    assert options_of(character.options).arms.name == "FK"


def test_a_corrected_role_is_the_persons(character: bpy.types.PropertyGroup) -> None:
    show_map(character.character_map, RIGIFY, {"hand.L": "hand.L is doubtful: look at it"})
    before = map_of(character.character_map)
    shown = role(character, "hand.L")
    assert shown.doubt and shown.source == before.roles["hand.L"].source
    shown.bones[0].bone = "finger.L"
    after = map_of(character.character_map)
    assert after.roles["hand.L"] == RoleBones(("finger.L",), 1.0, "you") and shown.doubt == ""
    assert "hand.L" not in after.fk and after.fk["hand.R"] == before.fk["hand.R"]
    assert {name: bones for name, bones in after.roles.items() if name != "hand.L"} == {
        name: bones for name, bones in before.roles.items() if name != "hand.L"
    }


def test_an_emptied_field_is_a_missing_role(character: bpy.types.PropertyGroup) -> None:
    role(character, "toe.L").bones[0].bone = ""
    role(character, "spine").bones[0].bone = ""
    found = map_of(character.character_map)
    assert "toe.L" not in found.roles and found.bones("spine") == ("chest",)


def test_a_bone_is_picked(character: bpy.types.PropertyGroup) -> None:
    assert bpy.ops.keymark.pick_bone(role="hand.L", bone="finger.L") == {"FINISHED"}
    assert (role(character, "hand.L").bones[0].bone, role(character, "hand.L").source) == ("finger.L", "you")
    for words, said in (
        ({"role": "tail"}, "no role 'tail'"),
        ({"role": "hand.L", "index": 3}, "no number 3"),
    ):
        with pytest.raises(RuntimeError, match=said):
            bpy.ops.keymark.pick_bone(bone="finger.L", **words)
    with pytest.raises(RuntimeError, match="has no bone 'nobody'"):
        bpy.ops.keymark.pick_bone(role="hand.L", bone="nobody")
    with pytest.raises(RuntimeError, match="No bone is chosen"):
        bpy.ops.keymark.pick_bone(role="hand.L")
    assert bpy.ops.keymark.pick_bone(role="hand.R", bone="finger.R") == {"FINISHED"}
    assert role(character, "hand.R").bones[0].bone == "finger.R"


def test_a_chain_grows_upward_and_shrinks(character: bpy.types.PropertyGroup) -> None:
    spine = role(character, "spine")
    spine.bones[1].bone = ""
    bpy.ops.keymark.remove_chain_bone(role="spine", index=1)
    assert [entry.bone for entry in spine.bones] == ["spine"]
    bpy.ops.keymark.add_chain_bone(role="spine")
    assert [entry.bone for entry in spine.bones] == ["spine", "chest"] and spine.source == "you"
    bpy.ops.keymark.add_chain_bone(role="spine")  # the neck has its role
    assert [entry.bone for entry in spine.bones][:2] == ["spine", "chest"]
    assert spine.bones[2].bone not in ("neck", "shoulder.L", "shoulder.R")
    with pytest.raises(RuntimeError, match=r"'hand\.L' is no chain"):
        bpy.ops.keymark.add_chain_bone(role="hand.L")
    for _ in range(4):
        bpy.ops.keymark.remove_chain_bone(role="spine")
    assert [entry.bone for entry in spine.bones] == [""]


def test_left_is_mirrored_to_right(character: bpy.types.PropertyGroup) -> None:
    role(character, "hand.L").bones[0].bone = "finger.L"
    assert bpy.ops.keymark.mirror_roles() == {"FINISHED"}
    assert role(character, "hand.R").bones[0].bone == "finger.R"
    role(character, "foot.R").bones[0].bone = "toe.R"
    assert bpy.ops.keymark.mirror_roles(side="R") == {"FINISHED"}
    assert role(character, "foot.L").bones[0].bone == "toe.L"
    before = map_of(character.character_map)
    assert bpy.ops.keymark.mirror_roles(side="R") == {"CANCELLED"}
    assert map_of(character.character_map) == before


def test_a_map_is_saved_and_loaded(character: bpy.types.PropertyGroup, tmp_path: Path) -> None:
    role(character, "hand.L").bones[0].bone = "finger.L"
    saved = map_of(character.character_map)
    assert bpy.ops.keymark.save_map(filepath=str(tmp_path / "mine")) == {"FINISHED"}
    assert read_character_map(tmp_path / "mine.json").bones("hand.L") == ("finger.L",)
    role(character, "hand.L").bones[0].bone = "hand.L"
    assert bpy.ops.keymark.load_map(filepath=str(tmp_path / "mine.json")) == {"FINISHED"}
    assert map_of(character.character_map).roles == saved.roles


def test_a_map_for_other_bones_is_refused_and_changes_nothing(
    character: bpy.types.PropertyGroup, tmp_path: Path
) -> None:
    before = map_of(character.character_map)
    bpy.ops.keymark.save_map(filepath=str(tmp_path / "plain.json"))
    for bone in character.armature.data.bones:
        bone.name = f"{bone.name}_of_another"
    with pytest.raises(RuntimeError, match=r"plain\.json is for another character: 'Character' has no bone"):
        bpy.ops.keymark.load_map(filepath=str(tmp_path / "plain.json"))
    with pytest.raises(RuntimeError, match="No file is chosen"):
        bpy.ops.keymark.load_map()
    (tmp_path / "broken.json").write_text("{")
    with pytest.raises(RuntimeError, match=r"broken\.json"):
        bpy.ops.keymark.load_map(filepath=str(tmp_path / "broken.json"))
    assert map_of(character.character_map) == before


def test_a_map_in_the_library_folder_is_suggested(
    character: bpy.types.PropertyGroup, rig: bpy.types.Object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("keymark.operators.library.registry.own_folder", lambda: tmp_path)
    role(character, "hand.L").bones[0].bone = "finger.L"
    character.character_map.title = "My Hero"
    bpy.ops.keymark.save_map(filepath=str(tmp_path / "hero.json"))
    bpy.ops.keymark.remove_character()
    bpy.ops.keymark.add_character(armature=rig.name)
    anew = active_take(bpy.context.scene).characters[0]
    assert (anew.suggested, role(anew, "hand.L").bones[0].bone) == ("My Hero", "hand.L")
    assert bpy.ops.keymark.load_map(title=anew.suggested) == {"FINISHED"}
    assert (anew.suggested, role(anew, "hand.L").bones[0].bone) == ("", "finger.L")
