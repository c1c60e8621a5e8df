"""The page that describes character maps tells the truth."""

import re
from pathlib import Path

import pytest
from keymark.core.prior.texts import LONGEST_NAME
from keymark.core.retarget.character import LIMBS, ROLES, SOURCES
from keymark.core.retarget.maps import character_map
from keymark.core.retarget.maps import character_map as character_map_file
from keymark.core.retarget.maps.character_map import CharacterMap, read_character_map, write_character_map


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    """docs/character_map_format.md."""
    return (repository / "docs" / "character_map_format.md").read_text(encoding="utf-8")


def test_the_example_is_a_map_and_laid_out_as_one(page: str, tmp_path: Path) -> None:
    (example,) = re.findall(r"```json\n(.*?)```", page, flags=re.DOTALL)
    (tmp_path / "given.json").write_text(example, encoding="utf-8")
    anna = read_character_map(tmp_path / "given.json")
    write_character_map(tmp_path / "anna.json", anna)
    assert (tmp_path / "anna.json").read_text(encoding="utf-8") == example
    assert anna.roles["foot.L"].confidence == 0.6 and anna.settings[1].value is True


def test_every_field_and_role_is_named(page: str) -> None:
    header = page.split("## The map")[1].split("## Roles")[0]
    assert [name for name in CharacterMap.ORDER if f"`{name}`" not in header] == []
    parts = {role.partition(".")[0] for role in ROLES}
    assert [name for name in (*parts, *LIMBS, *SOURCES) if f"`{name}`" not in page] == []


@pytest.mark.parametrize(
    "words",
    [
        f"| {LONGEST_NAME} characters |",
        f"| {character_map.MOST_SETTINGS} |",
        f"| {character_map.MOST_SOLE_POINTS} points each |",
        f"up to {character_map.LONGEST_BONE} characters",
        f"1 to {character_map.MOST_BONES}, from the hips",
        f"above {character_map_file.LARGEST_BYTES // 2**20} MiB",
    ],
)
def test_limits_are_those_of_the_reader(page: str, words: str) -> None:
    assert words in page
