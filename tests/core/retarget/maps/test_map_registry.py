"""The registry of character maps."""

from dataclasses import replace
from pathlib import Path

import pytest
from _characters import full_map, plain_character, plain_map
from _libraries import small_library
from keymark.core.errors import InputError
from keymark.core.prior.library import write_library
from keymark.core.prior.registry import identifier_of, registered_libraries
from keymark.core.retarget.maps.character_map import write_character_map
from keymark.core.retarget.maps.map_registry import find_map, map_digests, map_for, map_path, registered_maps
from keymark.core.take.conversion_settings import AUTO, NO_MAP

PLAIN = plain_map(plain_character())
UPPER = {key: key.upper() for key in plain_character().index}


@pytest.fixture
def folders(tmp_path: Path) -> list[Path]:
    """Own maps beside a keyframe library, a folder that is not there, and a studio's maps."""
    own, studio = tmp_path / "own", tmp_path / "studio"
    write_library(own / "small_steps.json", small_library())
    write_character_map(own / "mine.json", replace(PLAIN, title="Plain", author="Me"))
    write_character_map(studio / "plain.json", PLAIN)
    write_character_map(studio / "anna.json", full_map())
    return [own, tmp_path / "nowhere", studio]


def test_maps_and_libraries_share_folders_and_a_broken_file_hides_nothing(folders: list[Path]) -> None:
    maps = registered_maps(folders)
    assert [(entry.title, entry.path.name) for entry in maps] == [
        ("Anna, größer", "anna.json"),
        ("Plain", "mine.json"),
    ]
    assert [identifier_of(entry) for entry in registered_libraries(folders)] == ["small_steps"]
    (folders[0] / "broken.json").write_text('{"schema": "keymark-character", ')
    broken = next(entry for entry in registered_maps(folders) if entry.content is None)
    assert broken.title == "broken.json" and "no valid JSON" in broken.problem
    assert len(registered_maps(folders)) == 3
    with pytest.raises(InputError, match="no valid JSON"):
        find_map("broken", folders)


def test_maps_are_found_by_title_file_and_path(folders: list[Path]) -> None:
    for name in ("anna, GRÖSSER", "anna", folders[2] / "anna.json", str(folders[2] / "anna.json")):
        assert find_map(name, folders).content == full_map()
    (own,), every = map_digests("anna", folders), map_digests(AUTO, folders)
    assert own in every and len(set(every)) == 2 and map_digests(NO_MAP, folders) == ()
    with pytest.raises(InputError, match="no character map 'Plane' .is 'Plain' meant.*known are Anna, gr"):
        find_map("Plane", folders)
    with pytest.raises(InputError, match="known are none"):
        find_map("Plain", [])


def test_a_character_finds_the_map_of_its_bones(folders: list[Path]) -> None:
    found = map_for(plain_character(), folders)
    assert found is not None and found.path == folders[0] / "mine.json"
    assert map_for(plain_character(names=UPPER), folders) is None
    controls = ("torso", "chest control", "hand_ik.L", "elbow.L", "foot_ik.R", "toe_ik.R")
    base = plain_character(root="root")
    more = tuple(replace(base.bones[0], name=name, parent=0) for name in controls)
    found = map_for(replace(base, bones=(*base.bones, *more)), folders)
    assert found is not None and found.path.name == "anna.json"


def test_a_map_is_saved_over_itself_and_over_nothing_else(folders: list[Path]) -> None:
    own = folders[0]
    assert map_path(own, "PLAIN") == own / "mine.json"
    assert map_path(own, "Small Steps") == own / "small_steps_2.json"
    assert map_path(own, "../../etc/passwd") == own / "etc_passwd.json"
    assert map_path(own, "初音") == own / "character.json"
