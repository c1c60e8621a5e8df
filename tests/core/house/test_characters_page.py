"""docs/characters.md names every option and field, and its example is one that is read."""

import argparse
import re
from pathlib import Path

import pytest
from _synthetic_take import write_synthetic_take
from keymark.core.take.conversion_settings import CHARACTER_ENDINGS, CharacterFields, CharacterOptions
from keymark.core.take.description import describe
from keymark.operators.cli.commands.character import CHARACTER
from keymark.operators.cli.commands.retarget import RETARGET


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    """The page."""
    return (repository / "docs" / "characters.md").read_text(encoding="utf-8")


def test_every_option_is_described(page: str) -> None:
    for command in (CHARACTER, RETARGET):
        parser = argparse.ArgumentParser()
        for names, settings in command.arguments:
            parser.add_argument(*names, **settings)
        options = [max(action.option_strings) for action in parser._actions if action.option_strings]
        assert [one for one in options if one not in ("--help", "--replace") and one not in page] == []
    assert [ending for ending in CHARACTER_ENDINGS if f"`{ending}`" not in page] == []


def test_every_field_is_described(page: str) -> None:
    section = page.split("## In a shoot")[1]
    assert [name for name in CharacterFields.ORDER if f"`{name}`" not in section] == []
    assert f"{CharacterOptions().tolerance_mm:g} by default" in section


def test_the_example_is_read(page: str, tmp_path: Path) -> None:
    (example,) = re.findall(r"```json\n(.*?)```", page.split("## In a shoot")[1], flags=re.DOTALL)
    (tmp_path / "shoot.json").write_text(example, encoding="utf-8")
    settings = describe(write_synthetic_take(tmp_path / "take", 3)).settings.character
    assert settings is not None and settings.file.object == "rig" and settings.options.tolerance_mm == 2.0
    assert settings.options.legs == "ik" and settings.map_file == tmp_path / "cast" / "anna.json"
