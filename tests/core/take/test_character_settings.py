"""The character of a take: how files and the command line name it."""

from pathlib import Path

import pytest
from _synthetic_take import write_json, write_synthetic_take
from keymark.core.errors import InputError
from keymark.core.take.conversion_settings import (
    CharacterFile,
    RetargetOptions,
)
from keymark.core.take.description import describe


@pytest.mark.parametrize(
    ("text", "path", "name"),
    [
        ("anna.blend", "anna.blend", None),
        ("a/anna.blend:rig", "a/anna.blend", "rig"),
        ("anna.GLB", "anna.GLB", None),
        (r"C:\characters\anna.fbx", r"C:\characters\anna.fbx", None),
        (r"C:\characters\anna.fbx:Armature", r"C:\characters\anna.fbx", "Armature"),
        ("C:/anna.vrm:a:b", "C:/anna.vrm", "a:b"),
        ("day:1/my.blend files/anna.gltf:rig.001", "day:1/my.blend files/anna.gltf", "rig.001"),
    ],
)
def test_a_character_is_named_by_file_and_object(text: str, path: str, name: str | None) -> None:
    found = CharacterFile.parse(text)
    assert str(found.path) == path and found.object == name and str(found) == text


@pytest.mark.parametrize(
    "text", ["", "anna", "anna.obj", "anna.blend:", "rig:anna.json", ":rig", "anna.blend1"]
)
def test_what_names_no_character_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="names no character.*.blend, .fbx, .glb, .gltf, .vrm"):
        CharacterFile.parse(text)


@pytest.fixture
def take(tmp_path: Path) -> Path:
    """A take two folders below a shoot that names a character."""
    shoot = {"root": True, "character": {"file": "cast/anna.blend", "object": "rig", "map": "cast/anna.json"}}
    write_json(tmp_path / "shoot.json", shoot)
    return write_synthetic_take(tmp_path / "day" / "take", 3)


def test_a_take_inherits_the_character_field_by_field(take: Path, tmp_path: Path) -> None:
    settings = describe(take).settings.character
    assert settings is not None and settings.options == RetargetOptions()
    assert settings.character_file == CharacterFile(tmp_path / "cast" / "anna.blend", "rig")
    assert settings.map_file == tmp_path / "cast" / "anna.json"
    write_json(tmp_path / "day" / "shoot.json", {"character": {"map": "own.json", "legs": "fk", "//": "x"}})
    settings = describe(take).settings.character
    assert settings is not None and settings.file == tmp_path / "cast" / "anna.blend"
    assert settings.map_file == tmp_path / "day" / "own.json" and settings.options.legs == "fk"
    write_json(tmp_path / "day" / "shoot.json", {"character": None})
    assert describe(take).settings.character is None


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("file", "../anna.blend", "file is '../anna.blend'; it must be the path of a character file inside"),
        ("file", "/anna.blend", "inside the folder"),
        ("file", "anna.txt", "ending in .blend, .fbx, .glb, .gltf or .vrm"),
        ("object", " ", "object is ' '"),
        ("map", "a/b", "map is 'a/b'; it must be a character map's title, auto, none"),
        ("map", "../m.json", "map is '../m.json'"),
        ("root_motion", "sideways", "one of as-filmed, in-place, root-bone"),
        ("place", 3, "place is 3"),
        ("plant_feet", "yes", "plant_feet is 'yes'; it must be true or false"),
        ("tolerance_mm", 1e9, "from 0 to 1000 mm"),
        ("speed", 1, "unknown field 'speed'"),
    ],
)
def test_every_mistake_is_named(take: Path, tmp_path: Path, field: str, value: object, said: str) -> None:
    day = tmp_path / "day" / "shoot.json"
    write_json(day, {"character": {field: value}})
    with pytest.raises(InputError, match=said) as caught:
        describe(take)
    assert str(caught.value).startswith(str(day))


def test_a_character_outside_of_the_shoot_is_refused(take: Path, tmp_path: Path) -> None:
    outside = tmp_path.parent / f"{tmp_path.name} outside.blend"
    outside.write_bytes(b"")
    (tmp_path / "cast").mkdir()
    try:
        (tmp_path / "cast" / "anna.blend").symlink_to(outside)
    except OSError:
        pytest.skip("this system has no such links")
    with pytest.raises(InputError, match=r"anna\.blend: leads by a link to"):
        describe(take)
