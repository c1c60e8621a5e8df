"""Character map files: what is written is read again; whatever else they hold is refused in one sentence."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _characters import full_map, plain_character, plain_map
from _fuzz import FUZZ, changed
from hypothesis import HealthCheck, given, settings
from keymark.core.errors import InputError
from keymark.core.retarget.maps.character_map import (
    LARGEST_BYTES,
    CharacterMap,
    RoleBones,
    read_character_map,
    write_character_map,
)
from keymark.core.retarget.maps.map_registry import check_map, missing_bones

MAP = full_map()
VALID = MAP.to_json()
TEXT = json.dumps(VALID, ensure_ascii=False)


def test_a_map_comes_back_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "anna.json"
    write_character_map(path, MAP)
    again = read_character_map(path)
    assert again == MAP
    assert [type(setting.value) for setting in again.settings] == [float, int, bool]
    first = path.read_bytes()
    write_character_map(path, again)
    assert path.read_bytes() == first


def test_what_is_left_out_has_a_default_and_a_turn_that_is_nearly_one_is_made_one() -> None:
    value = {name: VALID[name] for name in ("schema", "schema_version", "title")}
    found = CharacterMap.from_json(value | {"roles": {"hips": {"bones": ["a"]}}}, "here")
    assert found.roles["hips"] == RoleBones(("a",), 1.0, "you")
    assert not (found.fk or found.ik or found.settings or found.soles or found.left_alone or found.root)
    value = VALID | {"rest_corrections": {"hips": [0.7071, 0.7071, 0, 0]}}
    turn = CharacterMap.from_json(value, "here").rest_corrections["hips"]
    assert abs(np.linalg.norm(turn) - 1.0) < 1e-12


@pytest.mark.fuzz
@settings(max_examples=100 * FUZZ, suppress_health_check=list(HealthCheck))
@given(changed(VALID))
def test_a_changed_map_is_one_or_says_why_not(value: Any) -> None:
    try:
        found = CharacterMap.from_json(value, "here")
    except InputError as error:
        assert len(str(error).splitlines()) == 1 and str(error).isprintable() and len(str(error)) < 1500
        return
    again = found.to_json()
    assert CharacterMap.from_json(again, "here").to_json() == again
    json.dumps(again, allow_nan=False).encode()


MANY = {f"b{n}": 0 for n in range(200_000)}
BOMBS = {
    "many fields": VALID | MANY,
    "many roles": VALID | {"roles": MANY},
    "many bones": VALID | {"roles": {"spine": {"bones": [f"b{n}" for n in range(90_000)]}}},
    "a long bone": VALID | {"roles": {"hips": {"bones": ["b" * 900_000]}}},
    "many settings": VALID | {"settings": [VALID["settings"][0]] * 9000},
    "many points": VALID | {"soles": {"foot.L": [[0, 0, 0]] * 90_000}},
    "a long title": VALID | {"title": "t" * 900_000},
    "nothing": {},
}


@pytest.mark.parametrize("kind", BOMBS)
def test_what_is_meant_to_hurt_is_refused(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "bomb.json"
    path.write_text(json.dumps(BOMBS[kind]))
    with pytest.raises(InputError, match=r"bomb\.json") as caught:
        read_character_map(path)
    assert len(str(caught.value).splitlines()) == 1 and len(str(caught.value)) < 1500


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "map.json").write_bytes(b" " * (LARGEST_BYTES + 1))
    with pytest.raises(InputError, match="at most 1 are read"):
        read_character_map(tmp_path / "map.json")


@pytest.mark.parametrize(
    ("way", "value", "said"),
    [
        (("schema",), "keymark-library", 'a character map has "keymark-character" there'),
        (("schema_version",), 2, "newer Keymark"),
        (("title",), "a\nb", "control characters"),
        (("titel",), "x", "unknown field 'titel' \\(is 'title' meant\\?\\)"),
        (("roles",), {}, "roles is empty"),
        (("roles", "hip"), {"bones": ["a"]}, "unknown field 'hip' \\(is 'hips' meant\\?\\)"),
        (("roles", "hips", "bones"), [], "a list of 1 to 1 bones"),
        (("roles", "hips", "bones"), ["thigh.L"], "'thigh.L' plays hips and thigh.L"),
        (("roles", "hips", "bones"), [" "], r"bones\[0\] is ' '; it must be a bone's name"),
        (("roles", "hips", "bones"), ["a\u202eb"], "a bone's name"),
        (("roles", "spine", "bones"), ["a", "a"], "names the bone 'a' twice"),
        (("roles", "hips", "confidence"), -0.1, "from 0 to 1"),
        (("roles", "hips", "confidence"), True, "confidence is True"),
        (("roles", "hips", "source"), "magic", "one of preset, names, shape, you"),
        (("roles", "hips", "shares"), [1], "shares is for spine, neck alone"),
        (("roles", "spine", "shares"), [1.0, 0.5], "none below the one before"),
        (("roles", "spine", "shares"), [1.0], "2 numbers from 0 to 1"),
        (("fk", "spine"), ["chest control"], "as many as the bones of spine"),
        (("fk", "hips"), ["chest control"], "names the bone 'chest control' twice"),
        (("ik", "arm.X"), {"goal": "a"}, "unknown field 'arm.X'"),
        (("ik", "arm.L", "goal"), None, "goal is null"),
        (("ik", "arm.L", "toe"), "toe", "toe is a control of legs alone"),
        (("ik", "arm.L", "switch", "ik"), 1.0, "a switch has two values"),
        (("settings", 0, "value"), "on", "value is 'on'"),
        (("settings", 0, "value"), 1.5e6, "value is 1500000.0"),
        (("settings", 1), VALID["settings"][0], "twice"),
        (("root",), 3, "root is 3; it must be a bone's name"),
        (("soles", "foot.L", 0), [0.0, 1e9, 0.0], r"foot.L\[0\] is \[0.0, 1000000000.0, 0.0\]"),
        (("soles", "foot.L"), [], "a list of 1 to 1000 points"),
        (("rest_corrections", "upper_arm.L"), [0.5, 0, 0, 0], "a quaternion .w, x, y, z. of length 1"),
        (("left_alone",), ["tail"], r"left_alone\[0\] is 'tail'"),
        (("license",), "free!", "SPDX"),
    ],
)
def test_every_mistake_is_named(way: tuple[Any, ...], value: Any, said: str) -> None:
    whole = json.loads(TEXT)
    holder = whole
    for key in way[:-1]:
        holder = holder[key]
    holder[way[-1]] = value
    with pytest.raises(InputError, match=said) as caught:
        CharacterMap.from_json(whole, "anna.json")
    assert str(caught.value).startswith("anna.json")


def test_a_control_needs_its_role_and_what_could_not_be_read_is_not_written(tmp_path: Path) -> None:
    roles = {name: value for name, value in VALID["roles"].items() if name != "hips"}
    with pytest.raises(InputError, match="fk: hips is keyed, but roles says no bone for it"):
        CharacterMap.from_json(VALID | {"roles": roles}, "anna.json")
    with pytest.raises(InputError, match="confidence"):
        write_character_map(tmp_path / "x.json", replace(MAP, roles={"hips": RoleBones(("a",), 2.0)}))
    assert list(tmp_path.iterdir()) == []


def test_a_map_for_other_bones_names_map_character_and_bones() -> None:
    character = plain_character()
    mine = plain_map(character)
    check_map(mine, character)
    assert missing_bones(mine, plain_character(without=("toe",))) == ("toe.L", "toe.R")
    other = plain_character(names={key: key.upper() for key in character.index})
    with pytest.raises(InputError) as caught:
        check_map(mine, other, "maps/plain.json")
    sentence = str(caught.value)
    assert sentence.startswith("maps/plain.json is for another character: 'Character' has no bone 'hips'")
    assert " more; choose a map" in sentence
    controlled = replace(mine, root="no such root")
    with pytest.raises(InputError, match="character map 'Plain' is for another.*no bone 'no such root'"):
        check_map(controlled, character)


def test_a_map_without_a_thigh_is_not_enough() -> None:
    character = plain_character()
    mine = plain_map(character)
    half = replace(mine, roles={role: bones for role, bones in mine.roles.items() if role != "thigh.R"})
    CharacterMap.from_json(half.to_json(), "half.json")
    with pytest.raises(InputError, match=r"gives no bones for thigh.R of 'Character'"):
        check_map(half, character)
