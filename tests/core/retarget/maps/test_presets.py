"""Presets: what is shipped is valid and found by its own bones; a reader that refuses the rest."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from _characters import convention_names, plain_character
from keymark.core.errors import InputError
from keymark.core.retarget.character import REQUIRED, Character
from keymark.core.retarget.maps.presets import SHIPPED, find_preset, preset_from_json, shipped_presets

PRESETS = shipped_presets()
VALID: dict[str, Any] = {
    "schema": "keymark-character-preset",
    "schema_version": 1,
    "title": "Plain",
    "requires": ["pelvis", "arm.L"],
    "lacks": ["tail"],
    "roles": {"hips": {"bones": ["pelvis"]}, "upper_arm.L": {"bones": ["arm.L"]}},
    "ik": {"arm.L": {"goal": "goal.L", "pole": "pole.L"}},
    "settings": [{"bone": "goal.L", "property": "stretch", "value": 0.0}],
    "root": "root",
}


def named(*names: str) -> Character:
    """A character with some bones."""
    bone = replace(plain_character().bones[0], parent=-1)
    return Character("Named", tuple(replace(bone, name=name) for name in names))


@pytest.mark.parametrize("preset", PRESETS, ids=lambda preset: preset.identifier)
def test_a_shipped_preset_is_found_by_its_own_bones(preset: Any) -> None:
    whole = find_preset(named(*preset.character_map.named_bones, *preset.requires))
    assert whole is not None and whole.preset == preset.identifier
    assert whole.roles.keys() == preset.character_map.roles.keys() and whole.ik == preset.character_map.ik
    least = find_preset(named(*preset.requires))
    assert least is not None and least.preset == preset.identifier
    missing = [role for role in REQUIRED if role not in preset.character_map.roles]
    assert missing == (["hips"] if preset.identifier == "mmd" else [])
    assert not set(preset.requires) & set(preset.lacks)


@pytest.mark.parametrize("path", sorted(SHIPPED.glob("*.json")), ids=lambda path: path.stem)
def test_a_shipped_preset_is_a_character_map_with_two_more_fields(path: Path, repository: Path) -> None:
    schema = json.loads((repository / "presets/schemas/character.schema.json").read_text(encoding="utf-8"))
    value = json.loads(path.read_text(encoding="utf-8"))
    assert value.pop("requires") and value.pop("lacks", True)
    assert value["schema"] == "keymark-character-preset"
    jsonschema.validate(value | {"schema": "keymark-character"}, schema)


@pytest.mark.parametrize("prefix", ["", "rig:", "mixamorig3:", "Character1_", "a.b_"])
def test_any_namespace_may_stand_before_the_names(prefix: str) -> None:
    found = find_preset(named(*(f"{prefix}{name}" for name in PRESETS_MIXAMO)))
    assert found is not None and found.preset == "mixamo"
    assert found.bone("upper_arm.L") == f"{prefix}LeftArm"


def test_case_and_separators_do_not_count_and_a_prefix_of_letters_is_no_namespace() -> None:
    unreal = sorted(set(convention_names("Unreal").values()))
    changed = find_preset(named("upperarm.l", *(name.replace("_", " ").title() for name in unreal)))
    assert changed is not None and changed.bone("thigh.L") == "Thigh L"
    assert find_preset(named(*(f"sub{name}" for name in PRESETS_MIXAMO))) is None


PRESETS_MIXAMO = tuple(sorted(set(convention_names("Ready Player Me").values())))


def test_bones_that_must_lack_exclude_a_preset_and_what_a_character_lacks_is_left_out() -> None:
    preset = preset_from_json(VALID, "here", "plain")
    for names in (("pelvis", "arm.L", "tail"), ("pelvis",)):
        assert find_preset(named(*names), (preset,)) is None
    bare = find_preset(named("pelvis", "arm.L"), (preset,))
    assert bare is not None and not bare.ik and not bare.settings and bare.root is None
    full = find_preset(named("pelvis", "arm.L", "goal.L", "root"), (preset,))
    assert full is not None and full.ik["arm.L"].goal == "goal.L" and full.ik["arm.L"].pole is None
    assert full.settings[0].bone == "goal.L" and full.root == "root"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"schema": "keymark-character"}, "schema is 'keymark-character'"),
        ({"schema_version": 2}, "newer Keymark"),
        ({"requires": []}, "requires"),
        ({"requires": None}, "requires"),
        ({"requires": ["a", "a"]}, "twice"),
        ({"lacks": "tail"}, "lacks"),
        ({"preset": "mixamo"}, "leave it out"),
        ({"require": ["a"]}, "unknown field 'require'"),
        ({"roles": {}}, "roles"),
    ],
)
def test_an_invalid_preset_is_refused_in_a_sentence(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError) as error:
        preset_from_json(VALID | changes, "here", "plain")
    assert words in str(error.value) and "here" in str(error.value)
